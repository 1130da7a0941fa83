// The ray-marcher's one loop. The includer supplies visit(); primary and shadow rays differ only in that.
//
// The tree is walked by restart from the root (kd-restart; Crassin et al. 2008, section 5.1): a ray finds the tile that
// its cone asks for, marches its brick, and starts again behind it. Progress is by integer neighbour steps: every step
// moves one coordinate of `voxel` by at least one in the ray's direction, so no epsilon is needed and no ray can stall.
//
// With PROGRESSIVE, for frames that must not take long, rays also ask for the bricks of the nodes that they pass, without
// waiting for them; and when time is up (stand_in), what is missing is shown by the nearest ancestor that has a brick.
//
// Needs the defines TREE_N, BRICK_M, BRICK_MIPS, MAX_LEVEL (the tree's depth), HAS_COLOR, PROGRESSIVE and BLENDED.
#include "march/buffers.glsl"
#include "march/tree_cells.glsl"
#include "march/ray.glsl"

#define MARCH_DONE 0
#define MARCH_MISSING 1

// An occupied voxel that a ray crosses.
struct Sample {
    ivec3 texel;          // first texel of the brick's mip, border included
    int mip;              // of the brick
    ivec3 voxel;          // in the mip, [0, MIP_M(mip))
    vec3 middle;          // middle of the chord, in voxels of the mip, [0, MIP_M(mip)]
    vec3 centre;          // of the voxel, from the root cube's low corner
    float t;              // distance of the chord's middle
    float side;           // of the voxel
    float share;          // weight against the other mip's voxels in the same place, (0, 1]
};

// Takes one occupied voxel; false stops the ray.
bool visit(inout Ray ray, Sample s);

#include "march/queries.glsl"
#if BLENDED
#include "march/blended_size.glsl"
#endif
#include "march/descend.glsl"
#include "march/skim.glsl"

#define SEEK_OCCUPIED 0
#define SEEK_DONE 1
#define SEEK_MISSING 2

// Brings the ray to its next occupied voxel: down the tree, over empty tiles, through bricks.
int seek(inout Ray ray, inout Place place, inout int turns) {
    for (;;) {
        int empty_shift = 0;
        if (place.slot < 0) {
            if (turns > TURN_BUDGET) {
                atomicAdd(counters.paused, 1u);
                return SEEK_MISSING;
            }
            turns += MAX_LEVEL + 1;
            const int descent = descend(ray, place, empty_shift);
            if (descent == DESCENT_MISSING) return SEEK_MISSING;
        }
        if (place.slot < 0) {
            if (!step_over(ray, empty_shift)) return SEEK_DONE;
        } else {
            const int skimmed = skim(ray, place, turns);
            if (skimmed == SKIM_OCCUPIED) return SEEK_OCCUPIED;
            if (skimmed == SKIM_ENDED) return SEEK_DONE;
            place.slot = -1;
        }
    }
}

// Takes the voxel of a mip around the ray's voxel, which must be occupied, and brings the ray behind it. `goes_on` says
// whether there is more of the ray; false when visit() has stopped it.
bool take_voxel(inout Ray ray, Place place, int mip, float share, out bool goes_on) {
    const int voxel_shift = own_shift_of(place) + mip;
    const ivec3 low = cell_low(ray.voxel, voxel_shift);
    const ivec3 brick_low = cell_low(ray.voxel, own_shift_of(place) + M_SHIFT);
    const float side = float(cell_side(voxel_shift));
    const float t_in = ray.t;
    Sample s;
    s.texel = slot_texel(place.slot, mip);
    s.mip = mip;
    s.voxel = cell_of(low - brick_low, voxel_shift);
    s.side = side;
    s.share = share;
    s.centre = vec3(low) + 0.5 * side;
    goes_on = step_over(ray, voxel_shift);
    s.t = 0.5 * (t_in + ray.t);
    s.middle = clamp((ray.origin + ray.direction * s.t - vec3(brick_low)) / side, vec3(0.0), vec3(float(MIP_M(mip))));
    return visit(ray, s);
}

#if BLENDED
#include "march/blend.glsl"
#endif

// Marches until the ray is done, or until it misses a tile or pauses: then it stands where it resumes.
//
// Threads that run side by side all pay for what any of them does in an innermost loop, so the loops are nested by how
// seldom their work is needed: an occupied voxel, a tile, an empty cell.
int march(inout Ray ray) {
    Place place;
    place.slot = -1;
    place.tile_shift = ROOT_SHIFT;
    place.mip = 0;
#if PROGRESSIVE
    place.brick_shift = ROOT_SHIFT;
#endif
    place.summary = uvec2(0u);
    int turns = 0;
    for (;;) {
        ++turns;
        const int found = seek(ray, place, turns);
        if (found != SEEK_OCCUPIED) return found == SEEK_MISSING ? MARCH_MISSING : MARCH_DONE;
        const ivec3 tile = cell_of(ray.voxel, place.tile_shift);
        bool goes_on = true;
#if BLENDED
        if (needs_coarser(place, width_at(ray))) {
            place.slot = -1;
            continue;
        }
        if (!take_both(ray, place, goes_on) || !goes_on) return MARCH_DONE;
#else
        if (!take_voxel(ray, place, place.mip, 1.0, goes_on) || !goes_on) return MARCH_DONE;
#endif
        if (any(notEqual(cell_of(ray.voxel, place.tile_shift), tile))) place.slot = -1;
    }
}

#include "march/brick_texels.glsl"
#include "march/ray_state.glsl"

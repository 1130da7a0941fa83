// The loop of the ray-marcher. The includer supplies visit(), by which primary and shadow rays differ.
//
// A ray finds the tile that its cone asks for, marches the tile's brick, and looks for the next tile behind
// it (Crassin et al. 2008, section 5.1), in one of several ways (TRAVERSAL; descend.glsl). Progress is by
// integer steps: every step moves one coordinate of `voxel` by at least one in the ray's direction, so no
// epsilon is needed and no ray can stall.
//
// With PROGRESSIVE, for frames with a deadline, rays also query the bricks of the nodes that they pass,
// without waiting for them. When the time is up (stand_in), a missing tile is shown by its nearest ancestor
// that has a brick.
//
// With HAS_CONSTANT, tiles may hold one value that is not 0 (Crassin et al. 2008, section 4.2): the includer
// supplies visit_constant() too. With HAS_FINAL, tiles may be final: finer levels add nothing to them. With
// BLENDED, rays see two mips of a brick, whose shares change smoothly from one size of voxels to the next
// (blend.glsl).
//
// Needs the defines of TreeShape::defines() (with WINDOWS, for trees whose voxels a ray cannot count,
// MAX_LEVEL is the depth under a window's tiles) and of renderer/march/march_programs.h; and of the includer
// RAYS_WIDEN, whether cone_slope is other than 0, and VISIT_TURNS, the most loop turns of visit(), which a
// pass counts (TURN_BUDGET).
#include "interop/march.h"
#include "march/buffers.glsl"
#include "march/tree_cells.glsl"
#include "march/ray.glsl"
#if WINDOWS
#include "march/windows.glsl"
#else
bool leave_window(Ray ray) { return false; }  // there is one cube, the root
bool enter_windows(inout Ray ray) { return enter_root(ray); }
#endif

#define MARCH_DONE 0
#define MARCH_MISSING 1

// An occupied voxel that a ray crosses.
struct Sample {
    ivec3 texel;          // first texel of the brick's mip, border included
    int mip;              // mip of the brick
    ivec3 voxel;          // place in the mip, [0, MIP_M(mip))
    vec3 middle;          // middle of the chord, in voxels of the mip, [0, MIP_M(mip)]
    vec3 centre;          // centre of the voxel, from the root cube's low corner
    float t;              // distance of the chord's middle
    float side;           // side of the voxel
    float share;          // weight in the blend with the other mip, (0, 1]
};

// Takes one occupied voxel; false ends the ray.
bool visit(inout Ray ray, Sample s);

#if HAS_CONSTANT
// A constant tile that a ray crosses, as a number of equal voxels.
struct ConstantRun {
    vec4 mean;        // the value, as a texel of brick_color
    float t_in;       // distance where the ray enters the tile
    float t_out;      // distance where the ray leaves the tile, or ends
    int voxel_shift;  // log2 of a voxel's side
    int voxels;       // number of voxels that the ray crosses; at most 3 BRICK_M - 2
};

// Takes a constant tile; false ends the ray. `entered` is the ray where it enters the tile.
bool visit_constant(Ray entered, ConstantRun run);
#endif

#include "march/queries.glsl"
#if BLENDED
#include "march/blended_size.glsl"
#endif
#include "march/descend.glsl"
#include "march/skim.glsl"

#if HAS_CONSTANT
// Crosses a constant tile; false if the ray is done.
bool cross_constant(inout Ray ray, Place place, inout int turns) {
    const Ray entered = ray;
    ConstantRun run;
    run.mean = unpackUnorm4x8(texelFetch(node_means, int(place.entry)).x);
    run.t_in = ray.t;
    run.voxel_shift = voxel_shift_of(place);
    const bool goes_on = step_over(ray, place.tile_shift);
    run.t_out = min(ray.t, ray.t_end);
    // A step from voxel to voxel changes one coordinate by one.
    const ivec3 steps = abs(cell_of(ray.voxel, run.voxel_shift) - cell_of(entered.voxel, run.voxel_shift));
    run.voxels = min(steps.x + steps.y + steps.z, 3 * BRICK_M);
    turns += run.voxels;
    return visit_constant(entered, run) && (goes_on || leave_window(ray));
}
#endif

#define SEEK_OCCUPIED 0
#define SEEK_DONE 1
#define SEEK_MISSING 2

// Moves the ray to its next occupied voxel: down the tree, over empty tiles, through bricks.
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
#if HAS_CONSTANT
            if (descent == DESCENT_CONSTANT) {
                if (!cross_constant(ray, place, turns)) return SEEK_DONE;
                continue;
            }
#endif
        }
        bool goes_on = true;
        if (place.slot < 0) {
            goes_on = step_over(ray, empty_shift);
        } else {
            const int skimmed = skim(ray, place, turns);
            if (skimmed == SKIM_OCCUPIED) return SEEK_OCCUPIED;
            goes_on = skimmed != SKIM_ENDED;
            place.slot = -1;
        }
        if (!goes_on && !leave_window(ray)) return SEEK_DONE;
    }
}

// Takes the voxel of a mip around the ray's voxel, which must be occupied, and moves the ray behind it.
// `goes_on`: the ray has not come to its end. The result is false if visit() has ended the ray.
bool take_voxel(inout Ray ray, Place place, int mip, float share, out bool goes_on) {
    const int voxel_shift = brick_voxel_shift_of(place) + mip;
    const ivec3 low = cell_low(ray.voxel, voxel_shift);
    const ivec3 brick_low = cell_low(ray.voxel, brick_voxel_shift_of(place) + M_SHIFT);
    const float side = float(cell_side(voxel_shift));
    const float t_in = ray.t;
    Sample s;
    s.texel = first_texel(place.slot, mip);
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

// Marches until the ray is done, or until it misses a tile or pauses; then the ray stands where it will
// resume.
//
// Threads that run side by side all pay for the work of any of them in an innermost loop. So the loops are
// nested by how seldom their work is needed: an occupied voxel, a tile, an empty cell.
//
// `turns` counts the turns of the thread in this pass; a thread may march several rays.
int march(inout Ray ray, inout int turns) {
    Place place = no_place();
    forget_trail();
    for (;;) {
        turns += (1 + VISIT_TURNS) * (BLENDED != 0 ? 5 : 1);
        const int found = seek(ray, place, turns);
        if (found != SEEK_OCCUPIED) return found == SEEK_MISSING ? MARCH_MISSING : MARCH_DONE;
        const ivec3 tile = cell_of(ray.voxel, place.tile_shift);
        bool goes_on = true;
#if BLENDED
        const bool seen_on = take_both(ray, place, goes_on);
#else
        const bool seen_on = take_voxel(ray, place, 0, 1.0, goes_on);
#endif
        if (!seen_on) return MARCH_DONE;
        if (!goes_on) {
            if (!leave_window(ray)) return MARCH_DONE;
            place.slot = -1;
        } else if (any(notEqual(cell_of(ray.voxel, place.tile_shift), tile))) {
            place.slot = -1;
        }
#if BLENDED
        if (place.slot >= 0 && needs_coarser(ray, place)) place.slot = -1;
#endif
    }
}

int march(inout Ray ray) {
    int turns = 0;
    return march(ray, turns);
}

#include "march/brick_texels.glsl"
#include "march/ray_state.glsl"

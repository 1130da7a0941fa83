// The ray-marcher's one loop. The includer supplies visit(); primary and shadow rays differ only in that.
//
// A ray finds the tile that its cone asks for, marches its brick, and looks for the next tile behind it (Crassin et al.
// 2008, section 5.1), in one of several ways (TRAVERSAL; descend.glsl). Progress is by integer neighbour steps: every step
// moves one coordinate of `voxel` by at least one in the ray's direction, so no epsilon is needed and no ray can stall.
//
// With PROGRESSIVE, for frames that must not take long, rays also ask for the bricks of the nodes that they pass, without
// waiting for them; and when time is up (stand_in), what is missing is shown by the nearest ancestor that has a brick.
//
// With HAS_CONSTANT, tiles may hold one value that is not 0 (Crassin et al. 2008, section 4.2): the includer supplies
// visit_constant() too. With HAS_FINAL, tiles may have nothing finer to show.
//
// Needs the defines TREE_N, BRICK_M, MAX_LEVEL (the tree's depth, or with WINDOWS that under a window's tiles), HAS_COLOR,
// PROGRESSIVE and TRAVERSAL; WINDOWS for trees whose voxels a ray cannot count (windows.glsl); and of the includer
// RAYS_WIDEN: whether cone_slope is other than 0.
#include "march/buffers.glsl"
#include "march/tree_cells.glsl"
#include "march/ray.glsl"
#if WINDOWS
#include "march/windows.glsl"
#else
bool leave_window(Ray ray) { return false; }  // the one there is
bool enter_windows(inout Ray ray) { return enter_root(ray); }
#endif

#define MARCH_DONE 0
#define MARCH_MISSING 1

// An occupied voxel that a ray crosses.
struct Sample {
    int slot;
    ivec3 voxel;          // in the brick, [0, BRICK_M)
    vec3 middle;          // middle of the chord, brick voxels, [0, BRICK_M]
    vec3 centre;          // of the voxel, from the root cube's low corner
    float t;              // distance of the chord's middle
    float side;           // of the voxel
};

// Loop turns that visit() takes at most; a pass counts them (TURN_BUDGET).
#ifndef VISIT_TURNS
#define VISIT_TURNS 0
#endif

// Takes one occupied voxel; false stops the ray.
bool visit(inout Ray ray, Sample s);

#if HAS_CONSTANT
// A tile of one value that a ray crosses, as so many voxels that are all alike.
struct ConstantRun {
    vec4 mean;        // as the texels of brick_color
    float t_in;       // distance where the ray enters it
    float t_out;      // and where it leaves it, or ends
    int voxel_shift;  // log2 of a voxel's side
    int voxels;       // that the ray crosses; at most 3 BRICK_M - 2
};

// Takes it; false stops the ray. `entered` is the ray as it comes into the tile.
bool visit_constant(Ray entered, ConstantRun run);
#endif

#include "march/queries.glsl"
#include "march/descend.glsl"
#include "march/skim.glsl"

#if HAS_CONSTANT
// Through a tile of one value; false when the ray is done.
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

// Marches until the ray is done, or until it misses a tile or pauses: then it stands where it resumes.
//
// Threads that run side by side all pay for what any of them does in an innermost loop, so the loops are nested by how
// seldom their work is needed: an occupied voxel, a tile, an empty cell.
//
// `turns` counts what a thread has done in this pass; it may march several rays.
int march(inout Ray ray, inout int turns) {
    Place place;
    place.slot = -1;
    place.tile_shift = ROOT_SHIFT;
#if PROGRESSIVE
    place.brick_shift = ROOT_SHIFT;
#endif
#if HAS_CONSTANT
    place.entry = 0u;
#endif
    place.summary = uvec2(0u);
    forget_trail();
    for (;;) {
        turns += 1 + VISIT_TURNS;
        const int found = seek(ray, place, turns);
        if (found != SEEK_OCCUPIED) return found == SEEK_MISSING ? MARCH_MISSING : MARCH_DONE;
        const int voxel_shift = voxel_shift_of(place);
        const ivec3 tile = cell_of(ray.voxel, place.tile_shift);
        const ivec3 low = cell_low(ray.voxel, voxel_shift);
        const ivec3 brick_low = cell_low(ray.voxel, voxel_shift + M_SHIFT);
        const float side = float(cell_side(voxel_shift));
        const float t_in = ray.t;
        Sample s;
        s.slot = place.slot;
        s.voxel = cell_of(low - brick_low, voxel_shift);
        s.side = side;
        s.centre = vec3(low) + 0.5 * side;
        const bool goes_on = step_over(ray, voxel_shift);
        s.t = 0.5 * (t_in + ray.t);
        s.middle = clamp((ray.origin + ray.direction * s.t - vec3(brick_low)) / side, vec3(0.0),
                         vec3(float(BRICK_M)));
        if (!visit(ray, s)) return MARCH_DONE;
        if (!goes_on) {
            if (!leave_window(ray)) return MARCH_DONE;
            place.slot = -1;
        } else if (any(notEqual(cell_of(ray.voxel, place.tile_shift), tile))) {
            place.slot = -1;
        }
    }
}

int march(inout Ray ray) {
    int turns = 0;
    return march(ray, turns);
}

#include "march/brick_texels.glsl"
#include "march/ray_state.glsl"

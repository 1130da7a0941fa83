// The loop of the ray-marcher. The includer supplies visit(), by which primary and shadow rays differ.
//
// A ray finds the tile that its cone asks for, marches the tile's brick, and looks for the next tile behind
// it (Crassin et al. 2008, section 5.1), in one of several ways (TRAVERSAL; descend.glsl). Progress is by
// integer steps: every step moves one coordinate of `cell` by at least one in the ray's direction, so no
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
// RAYS_WIDEN, whether cone_slope is other than 0; VISIT_TURNS, the most loop turns of visit(), which a pass
// counts (TURN_BUDGET); and FIRST_MARK_ENDS, whether a ray ends at the first mark that it meets.
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

// Most loop turns in the marks of a voxel.
#define MARK_TURNS (MARKS != 0 ? 10 : 0)

#define MARCH_DONE 0
#define MARCH_MISSING 1

// What a ray meets: an occupied voxel or, with MARKS, a mark in one.
struct Sample {
#if PACKED
    int brick;            // first word of the brick
#else
    ivec3 texel;          // first texel of the brick's mip, border included
#endif
#if MARKS
    bool is_mark;
    bool is_in_slab;      // the surface is where the ray meets it
#endif
    int mip;              // mip of the brick
    ivec3 voxel;          // place in the mip, [0, MIP_M(mip))
    vec3 middle;          // middle of the chord, in voxels of the mip, [0, MIP_M(mip)]
    vec3 centre;          // centre of what is met, from the root cube's low corner
    float t;              // distance of the chord's middle
    float side;           // side of what is met
    float voxel_side;
    float share;          // weight in the blend with the other mip, (0, 1]
};

// Takes what a ray meets; false ends the ray.
bool visit(inout Ray ray, Sample s);

#if MARKS
// Does the ray meet the marks of an occupied voxel of this side? Else it meets the voxel as a whole, by its
// coverage.
bool meets_marks(Ray ray, float voxel_side);

// What visit() took counted: it was not passed over as the receiver's own.
bool is_counted = true;

#if FIRST_MARK_ENDS
// Does the ray pass over a mark that it meets at this distance? `corner`: the mark's low corner.
bool passes_over(Ray ray, vec3 corner, float side, float t);
#endif
#endif

#if HAS_CONSTANT
// A constant tile that a ray crosses, as a number of equal voxels.
struct ConstantRun {
    vec4 mean;        // the value, as a texel of a dense brick's colour
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
    const ivec3 steps = abs(cell_of(ray.cell, run.voxel_shift) - cell_of(entered.cell, run.voxel_shift));
    run.voxels = min(steps.x + steps.y + steps.z, 3 * BRICK_M);
    turns += run.voxels;
    return visit_constant(entered, run) && (goes_on || leave_window(ray));
}
#endif

#include "march/brick_texels.glsl"

#if MARKS
// Rounding errors of a ray's place, per distance from its origin and per length of the marched cube.
#define WAY_ERROR 4.76837158203125e-7     // 2^-21
#define PLACE_ERROR 1.1920928955078125e-7  // 2^-23

// Where a ray is between the planes of a voxel's slab: distances of its ends. They do not depend on where the ray
// started or resumed.
vec2 slab_crossing(Ray ray, Slab slab, vec3 centre, float side) {
    const vec3 away = centre - ray.origin;
    const float error = WAY_ERROR * (abs(away.x) + abs(away.y) + abs(away.z)) +
                        PLACE_ERROR * FINEST_LENGTH * float(MARCHED_SIDE);
    const float height = dot(slab.normal, away);
    const float rise = dot(slab.normal, ray.direction);
    const float inverse = 1.0 / (abs(rise) > 1e-6 ? rise : 1e-6);
    const float a = (height + slab.low * side - error) * inverse;
    const float b = (height + slab.high * side + error) * inverse;
    return vec2(min(a, b), max(a, b));
}

// Where the ray leaves what find_mark() has found, and whether that is a slab too.
float mark_end = 0.0;
bool is_mark_in_slab = false;

// Moves the ray, in an occupied voxel, to its next mark or, where the voxel has a slab, to where the ray is in both;
// false if it meets none there and has left the voxel. `goes_on`: the ray has not come to its end. (Amanatides and Woo
// 1987, in the 4^3 cells of the voxel.)
bool find_mark(inout Ray ray, Place place, int mip, out bool goes_on) {
    const int voxel_shift = brick_voxel_shift_of(place) + mip;
    const int mark_shift = voxel_shift - MARK_SHIFT;
    const Geometry there = geometry_of(place.brick, mip, place_in(ray.cell, voxel_shift, M_SHIFT - mip));
    const ivec3 low = cell_low(ray.cell, voxel_shift);
    const float side = cell_length(voxel_shift);
    vec2 slab = vec2(-ENDLESS, ENDLESS);
    is_mark_in_slab = there.has_slab;
    if (there.has_slab) slab = slab_crossing(ray, there.slab, corner_of(low) + 0.5 * side, side);
    // Where there is a slab alone, the ray goes there at once, but not behind the voxel.
    ivec3 first = ray.cell;
    float t_in = ray.t;
    if (!there.is_marked) {
        const ivec3 last = low + ray.positive * (cell_side(voxel_shift) - 1);
        const vec3 ends = mix((corner_of(last + ray.positive) - ray.origin) * ray.inverse, vec3(ENDLESS), ray.inert);
        t_in = max(t_in, min(slab.x, min(ends.x, min(ends.y, ends.z))));
        first = clamp(finest_cell_at(ray.origin + ray.direction * t_in), min(ray.cell, last), max(ray.cell, last));
    }
    ivec3 c = cell_of(first - low, mark_shift);
    const vec3 bound = corner_of(low + (c + ray.positive) * cell_side(mark_shift));
    const vec3 step_t = mix(abs(ray.inverse) * cell_length(mark_shift), vec3(ENDLESS), ray.inert);
    const ivec3 step_c = 2 * ray.positive - 1;
    vec3 t = mix((bound - ray.origin) * ray.inverse, vec3(ENDLESS), ray.inert);  // where it leaves the cell
    bool found = false;
    // A straight line crosses at most 10 of 4^3 cells.
    for (int i = 0; i < 10; ++i) {
        const float t_out = min(t.x, min(t.y, t.z));
        found = has_bit(there.marks, c.x + 4 * c.y + 16 * c.z) && t_out >= slab.x && t_in <= slab.y;
#if FIRST_MARK_ENDS
        if (found && passes_over(ray, corner_of(low + c * cell_side(mark_shift)), cell_length(mark_shift),
                                 0.5 * (max(t_in, slab.x) + min(t_out, slab.y))))
            found = false;
#endif
        mark_end = min(t_out, slab.y);
        if (found) break;
        t_in = t_out;
        const bool x = t.x == t_in;
        const bool y = !x && t.y == t_in;
        const bvec3 crossed = bvec3(x, y, !x && !y);
        c += mix(ivec3(0), step_c, crossed);
        t += mix(vec3(0.0), step_t, crossed);
        if (((c.x | c.y | c.z) & ~3) != 0) break;
    }
    if (found) t_in = max(t_in, slab.x);
    ray.t = max(t_in, ray.t);
    const ivec3 cell = low + c * cell_side(mark_shift);
    ray.cell = clamp(finest_cell_at(ray.origin + ray.direction * ray.t), cell, cell + (cell_side(mark_shift) - 1));
    const uvec3 place_now = uvec3(ray.cell);
    goes_on = max(place_now.x, max(place_now.y, place_now.z)) < uint(MARCHED_SIDE) && ray.t < ray.t_end;
    return found && goes_on;
}
#endif

#define SEEK_OCCUPIED 0
#define SEEK_DONE 1
#define SEEK_MISSING 2

// With blended mips the marks of both are looked at behind seek().
#define SEEKS_MARKS (MARKS != 0 && BLENDED == 0)

// Moves the ray to its next occupied voxel, or to its next mark: down the tree, over empty tiles, through
// bricks.
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
            const ivec3 tile = cell_of(ray.cell, place.tile_shift);
            const int skimmed = skim(ray, place, turns);
#if SEEKS_MARKS
            if (skimmed == SKIM_OCCUPIED) {
                turns += MARK_TURNS;
                if (!meets_marks(ray, cell_length(brick_voxel_shift_of(place))) || find_mark(ray, place, 0, goes_on))
                    return SEEK_OCCUPIED;
                if (goes_on && all(equal(cell_of(ray.cell, place.tile_shift), tile))) continue;
            }
#else
            if (skimmed == SKIM_OCCUPIED) return SEEK_OCCUPIED;
#endif
            goes_on = goes_on && skimmed != SKIM_ENDED;
            place.slot = -1;
        }
        if (!goes_on && !leave_window(ray)) return SEEK_DONE;
    }
}

// Takes what the ray meets in a voxel of a mip, which must be occupied: the whole voxel, or a mark. Moves the
// ray behind that. With blended mips the ray has yet to find a mark; if it meets none, it goes behind the
// voxel. `goes_on`: the ray has not come to its end. The result is false if visit() has ended the ray.
bool take_voxel(inout Ray ray, Place place, int mip, float share, out bool goes_on) {
    const int voxel_shift = brick_voxel_shift_of(place) + mip;
    const ivec3 brick_low = cell_low(ray.cell, brick_voxel_shift_of(place) + M_SHIFT);
    Sample s;
    s.voxel_side = cell_length(voxel_shift);
    int met_shift = voxel_shift;
#if MARKS
    s.is_mark = meets_marks(ray, s.voxel_side);
    if (s.is_mark) {
#if !SEEKS_MARKS
        if (!find_mark(ray, place, mip, goes_on)) return true;
#endif
        met_shift -= MARK_SHIFT;
    }
#endif
    const ivec3 low = cell_low(ray.cell, met_shift);
    const float t_in = ray.t;
#if PACKED
    s.brick = place.brick;
#else
    s.texel = first_texel(place.slot, mip);
#endif
    s.mip = mip;
    s.voxel = cell_of(low - brick_low, voxel_shift);
    s.side = cell_length(met_shift);
    s.share = share;
    s.centre = corner_of(low) + 0.5 * s.side;
    goes_on = step_over(ray, met_shift);
    s.t = 0.5 * (t_in + ray.t);
#if MARKS
    s.is_in_slab = s.is_mark && is_mark_in_slab;
    if (s.is_mark) s.t = 0.5 * (t_in + clamp(mark_end, t_in, ray.t));
#endif
    s.middle = clamp((ray.origin + ray.direction * s.t - corner_of(brick_low)) / s.voxel_side, vec3(0.0),
                     vec3(float(MIP_M(mip))));
    return visit(ray, s);
}

#if BLENDED
#include "march/blend.glsl"
#endif

#if SEEKS_MARKS && FIRST_MARK_ENDS
// Takes the mark that the ray is in.
void take_first_mark(inout Ray ray, Place place);
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
#if SEEKS_MARKS && FIRST_MARK_ENDS
    // All threads that run side by side take what they meet together.
    const int met = seek(ray, place, turns);
    if (met == SEEK_OCCUPIED) take_first_mark(ray, place);
    return met == SEEK_MISSING ? MARCH_MISSING : MARCH_DONE;
#else
    for (;;) {
        turns += (1 + VISIT_TURNS + MARK_TURNS) * (BLENDED != 0 ? 5 : 1);
        const int found = seek(ray, place, turns);
        if (found != SEEK_OCCUPIED) return found == SEEK_MISSING ? MARCH_MISSING : MARCH_DONE;
        const ivec3 tile = cell_of(ray.cell, place.tile_shift);
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
        } else if (any(notEqual(cell_of(ray.cell, place.tile_shift), tile))) {
            place.slot = -1;
        }
#if BLENDED
        if (place.slot >= 0 && needs_coarser(ray, place)) place.slot = -1;
#endif
    }
#endif
}

int march(inout Ray ray) {
    int turns = 0;
    return march(ray, turns);
}

#include "march/ray_state.glsl"

// The ray-marcher's one loop. The includer supplies visit(); primary and shadow rays differ only in that.
//
// The tree is walked by restart from the root (kd-restart; Crassin et al. 2008, section 5.1): a ray finds the tile that
// its cone asks for, marches its brick, and starts again behind it. Progress is by integer neighbour steps: every step
// moves one coordinate of `voxel` by at least one in the ray's direction, so no epsilon is needed and no ray can stall.
//
// With PROGRESSIVE, for frames that must not take long, rays also ask for the bricks of the nodes that they pass, without
// waiting for them; and when time is up (stand_in), what is missing is shown by the nearest ancestor that has a brick.
//
// Needs the defines TREE_N, BRICK_M, MAX_LEVEL (the tree's depth), HAS_COLOR and PROGRESSIVE.
#include "interop/config.h"
#include "interop/bindings.h"
#include "interop/types.h"
#include "pool/brick_masks.glsl"

#if TREE_N == 4
#define N_SHIFT 2
#elif TREE_N == 2
#define N_SHIFT 1
#endif
#if BRICK_M == 8
#define M_SHIFT 3
#elif BRICK_M == 16
#define M_SHIFT 4
#elif BRICK_M == 32
#define M_SHIFT 5
#elif BRICK_M == 64
#define M_SHIFT 6
#endif

#define ROOT_SHIFT (M_SHIFT + N_SHIFT * MAX_LEVEL)
#define ROOT_SIDE (1 << ROOT_SHIFT)

#define MARCH_DONE 0
#define MARCH_MISSING 1

layout(std140, binding = UBO_VIEW) uniform ViewBlock { MarchView view; };
layout(std430, binding = SSBO_RAYS) buffer RayBlock { RayState rays[]; };
layout(std430, binding = SSBO_LISTS) buffer ListBlock { uint lists[]; };
layout(std430, binding = SSBO_QUERIES) buffer QueryBlock {
    MarchCounters counters;
    uint queries[];
};
layout(std430, binding = SSBO_USAGE) buffer UsageBlock { uint usage[]; };
layout(std430, binding = SSBO_IMAGE) buffer ImageBlock { uint image_rgba8[]; };
layout(binding = TEXTURE_NODES) uniform usamplerBuffer nodes;
layout(binding = TEXTURE_BRICK_MASKS) uniform usamplerBuffer brick_masks;
layout(binding = TEXTURE_BRICK_COLOR) uniform sampler3D brick_color;
layout(binding = TEXTURE_BRICK_NORMAL) uniform sampler3D brick_normal;

uniform uint pass_number;
uniform uint usage_query_offset;  // word in usage[] where the query bits start
uniform ivec3 pool_slots;         // slots along each axis of the pool's textures
#if PROGRESSIVE
uniform bool stand_in;            // the last pass of a frame: no ray may wait
uniform uint entry_count;         // of the node pool
#endif

struct Ray {
    vec3 origin;
    vec3 direction;       // unit
    vec3 inverse;         // 1 / direction; 0 where inert
    bvec3 inert;          // the ray never crosses a plane of this axis: the component is 0, -0 or denormal
    ivec3 positive;       // 1 where the direction is positive
    float t;              // distance so far
    float t_end;
    ivec3 voxel;          // finest-level voxel that the ray is in
    float cone_base;      // pixel width at t is cone_base + cone_slope * t
    float cone_slope;
};

// An occupied voxel that a ray crosses.
struct Sample {
    int slot;
    ivec3 voxel;          // in the brick, [0, BRICK_M)
    vec3 middle;          // middle of the chord, brick voxels, [0, BRICK_M]
    vec3 centre;          // of the voxel, from the root cube's low corner
    float t;              // distance of the chord's middle
    float side;           // of the voxel
};

// Takes one occupied voxel; false stops the ray.
bool visit(inout Ray ray, Sample s);

Ray make_ray(vec3 origin, vec3 direction, float t_end, float cone_base, float cone_slope) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.inert = lessThan(abs(direction), vec3(1e-20));
    ray.inverse = mix(1.0 / mix(direction, vec3(1.0), ray.inert), vec3(0.0), ray.inert);
    ray.positive = ivec3(greaterThan(direction, vec3(0.0)));
    ray.t = 0.0;
    ray.t_end = t_end;
    ray.voxel = ivec3(0);
    ray.cone_base = cone_base;
    ray.cone_slope = cone_slope;
    return ray;
}

// Puts the ray where it enters the root cube, at ray.t or behind; false when it misses it.
bool enter_root(inout Ray ray) {
    const vec3 side = vec3(float(ROOT_SIDE));
    const vec3 low = -ray.origin;
    const vec3 high = side - ray.origin;
    // An inert axis bounds nothing when the origin lies between its planes, and everything when it does not.
    const bvec3 outside = notEqual(lessThanEqual(low, vec3(0.0)), greaterThanEqual(high, vec3(0.0)));
    if (any(bvec3(ray.inert.x && outside.x, ray.inert.y && outside.y, ray.inert.z && outside.z))) return false;
    const vec3 ta = mix(low * ray.inverse, vec3(-1e30), ray.inert);
    const vec3 tb = mix(high * ray.inverse, vec3(1e30), ray.inert);
    const vec3 near = min(ta, tb);
    const vec3 far = max(ta, tb);
    const float t_near = max(max(near.x, near.y), max(near.z, ray.t));
    const float t_far = min(far.x, min(far.y, far.z));
    if (t_near > t_far || t_near >= ray.t_end) return false;
    ray.t = t_near;
    ray.voxel = clamp(ivec3(floor(clamp(ray.origin + ray.direction * t_near, vec3(0.0), side))), ivec3(0),
                      ivec3(ROOT_SIDE - 1));
    return true;
}

// Steps over the aligned cell of side 1 << shift around the ray's voxel, to the voxel behind it; false when the ray has
// left the root cube or come to its end.
bool step_over(inout Ray ray, int shift) {
    const ivec3 low = (ray.voxel >> shift) << shift;
    const ivec3 high = low + ((1 << shift) - 1);
    const bvec3 forward = equal(ray.positive, ivec3(1));
    const vec3 bound = vec3(mix(low, high + 1, forward));
    const vec3 t = mix((bound - ray.origin) * ray.inverse, vec3(1e30), ray.inert);
    const float t_exit = max(min(t.x, min(t.y, t.z)), ray.t);
    const bool x = t.x <= t.y && t.x <= t.z;
    const bool y = !x && t.y <= t.z;
    const bvec3 leaves = bvec3(x, y, !x && !y);
    const ivec3 inside = clamp(ivec3(floor(ray.origin + ray.direction * t_exit)), low, high);
    // Rounding must not carry the other coordinates backwards.
    const ivec3 kept = mix(min(inside, ray.voxel), max(inside, ray.voxel), forward);
    ray.voxel = mix(kept, mix(low - 1, high + 1, forward), leaves);
    ray.t = t_exit;
    return all(equal(ray.voxel >> ROOT_SHIFT, ivec3(0))) && t_exit < ray.t_end;
}

// A 4^3 mask, x fastest: -1 when cell c is occupied, else log2 of the side of an empty aligned cell around it.
int empty_shift_4(uvec2 mask, ivec3 c) {
    const uint word = (c.z & 2) == 0 ? mask.x : mask.y;
    if ((word >> (c.x + 4 * c.y + 16 * (c.z & 1)) & 1u) != 0u) return -1;
    return (word >> ((c.x & 2) + 4 * (c.y & 2)) & 0x00330033u) == 0u ? 1 : 0;
}

// A 2^3 mask likewise.
int empty_shift_2(uint mask, ivec3 c) { return (mask >> (c.x + 2 * c.y + 4 * c.z) & 1u) != 0u ? -1 : 0; }

// The tile query buffer holds 2 * entry + kind, or 2 * entry_count + entry for a brick that could stand in.
void ask(uint bit) {
#if PROGRESSIVE
    // How many rays ask: several tiles may share a count, which only disturbs the order of their production.
    atomicAdd(queries[uint(QUERY_CAPACITY) + bit % uint(QUERY_COUNTS)], 1u);
#endif
    const uint old = atomicOr(usage[usage_query_offset + bit / 32u], 1u << (bit % 32u));
    if ((old >> (bit % 32u) & 1u) != 0u) return;  // another ray has asked
    const uint place = atomicAdd(counters.queries, 1u);
    if (place < uint(QUERY_CAPACITY)) queries[place] = bit;
}

void query(uint entry, uint kind) { ask(2u * entry + kind); }

// Tells the cache that this pass used the brick.
void touch(int slot) {
    if (usage[slot] != pass_number) atomicMax(usage[slot], pass_number);
}

// Which block of 4^3 voxels is empty: -1 when block c is not, else log2 of an empty aligned cell's side, in blocks.
int empty_block_shift(int slot, uvec2 summary, ivec3 c) {
#if BLOCKS_A_SIDE == 4
    return empty_shift_4(summary, c);
#elif BLOCKS_A_SIDE == 2
    return empty_shift_2(summary.x, c);
#else
    const int block = c.x + BLOCKS_A_SIDE * (c.y + BLOCKS_A_SIDE * c.z);
    const uvec2 word = texelFetch(brick_masks, slot * MASK_WORDS_A_SLOT + block / 64).xy;
    return ((block % 64 < 32 ? word.x : word.y) >> (block % 32) & 1u) != 0u ? -1 : 0;
#endif
}

// The brick that a ray is in.
struct Place {
    int slot;         // -1: none
    int tile_shift;   // log2 of the tile's side
#if PROGRESSIVE
    int brick_shift;  // log2 of the side of the tile whose brick it is: that one, or an ancestor that stands in
#endif
    uvec2 summary;    // which blocks of 4^3 voxels are not empty (all of them when there are at most 64)
};

// Log2 of a voxel's side.
int voxel_shift_of(Place place) {
#if PROGRESSIVE
    return place.brick_shift - M_SHIFT;
#else
    return place.tile_shift - M_SHIFT;
#endif
}

#define DESCENT_FOUND 0    // place holds a brick
#define DESCENT_EMPTY 1    // nothing here: `empty_shift` is the side of the cell to step over
#define DESCENT_MISSING 2  // the tile was asked for

void use_brick(inout Place place, int slot) {
    place.slot = slot;
    place.summary = texelFetch(brick_masks, slot * MASK_WORDS_A_SLOT).xy;
    touch(slot);
}

#if PROGRESSIVE
// The nearest node above the ray's voxel that has a brick.
struct Ancestor {
    int slot;  // -1: none
    int tile_shift;
};

// Shows the cell of side 1 << shift around the ray's voxel by the ancestor's brick, or as empty.
int stand_in_for_cell(Ancestor ancestor, int shift, inout Place place, out int empty_shift) {
    atomicAdd(counters.stood_in, 1u);
    empty_shift = shift;
    if (ancestor.slot < 0) return DESCENT_EMPTY;
    place.tile_shift = shift;
    place.brick_shift = ancestor.tile_shift;
    use_brick(place, ancestor.slot);
    return DESCENT_FOUND;
}
#endif

// Finds the tile that the ray's cone asks for at its voxel: kd-restart.
int descend(Ray ray, out Place place, out int empty_shift) {
    const float width = ray.cone_base + ray.cone_slope * ray.t;
    uint entry = 0u;
    uvec4 node = texelFetch(nodes, 0);
    place.slot = -1;
    place.tile_shift = ROOT_SHIFT;
#if PROGRESSIVE
    place.brick_shift = ROOT_SHIFT;
#endif
    place.summary = uvec2(0u);
    empty_shift = ROOT_SHIFT;
    if (MAX_LEVEL > 0 && (node.x | node.y) == 0u) return DESCENT_EMPTY;  // nothing in the whole scene
#if PROGRESSIVE
    Ancestor ancestor = Ancestor(-1, ROOT_SHIFT);
#endif
    for (int level = 0; level < MAX_LEVEL; ++level) {
        if (float(1 << (place.tile_shift - M_SHIFT)) <= width) break;
        const ivec3 c = (ray.voxel >> (place.tile_shift - N_SHIFT)) & (TREE_N - 1);
#if TREE_N == 4
        const int empty = empty_shift_4(node.xy, c);
#else
        const int empty = empty_shift_2(node.x, c);
#endif
        if (empty >= 0) {
            empty_shift = place.tile_shift - N_SHIFT + empty;
            return DESCENT_EMPTY;
        }
#if PROGRESSIVE
        if (node.w != 0u) ancestor = Ancestor(int(node.w) - 1, place.tile_shift);
        else ask(2u * entry_count + entry);
#endif
        if (node.z == 0u) {
            query(entry, QUERY_CHILDREN);
#if PROGRESSIVE
            if (stand_in) return stand_in_for_cell(ancestor, place.tile_shift - N_SHIFT, place, empty_shift);
#endif
            return DESCENT_MISSING;
        }
        entry = node.z + uint(c.x + TREE_N * (c.y + TREE_N * c.z));
        node = texelFetch(nodes, int(entry));
        place.tile_shift -= N_SHIFT;
    }
#if PROGRESSIVE
    place.brick_shift = place.tile_shift;
#endif
    if (node.w == 0u) {
        query(entry, QUERY_BRICK);
#if PROGRESSIVE
        if (stand_in) return stand_in_for_cell(ancestor, place.tile_shift, place, empty_shift);
#endif
        return DESCENT_MISSING;
    }
    use_brick(place, int(node.w) - 1);
    return DESCENT_FOUND;
}

#define SKIM_OCCUPIED 0  // the ray's voxel is occupied
#define SKIM_LEFT 1      // the ray left the tile
#define SKIM_ENDED 2     // the ray is done

// Skips the empty cells of a brick.
int skim(inout Ray ray, Place place, inout int turns) {
    const int voxel_shift = voxel_shift_of(place);
    const ivec3 tile = ray.voxel >> place.tile_shift;
    const int first_mask = place.slot * MASK_WORDS_A_SLOT + SUMMARY_WORDS;
    // A straight line crosses at most 3 M - 2 cells of a brick.
    for (int cell = 0; cell < 3 * BRICK_M; ++cell) {
        ++turns;
        const ivec3 b = (ray.voxel >> voxel_shift) & (BRICK_M - 1);
        const ivec3 c = b >> 2;
        int empty = empty_block_shift(place.slot, place.summary, c);
        int shift = voxel_shift + 2 + empty;
        if (empty < 0) {
            const uvec2 mask =
                texelFetch(brick_masks, first_mask + c.x + BLOCKS_A_SIDE * (c.y + BLOCKS_A_SIDE * c.z)).xy;
            empty = empty_shift_4(mask, b & 3);
            if (empty < 0) return SKIM_OCCUPIED;
            shift = voxel_shift + empty;
        }
        if (!step_over(ray, shift)) return SKIM_ENDED;
        if (any(notEqual(ray.voxel >> place.tile_shift, tile))) return SKIM_LEFT;
    }
    return SKIM_LEFT;
}

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

// Marches until the ray is done, or until it misses a tile or pauses: then it stands where it resumes.
//
// Threads that run side by side all pay for what any of them does in an innermost loop, so the loops are nested by how
// seldom their work is needed: an occupied voxel, a tile, an empty cell.
int march(inout Ray ray) {
    Place place;
    place.slot = -1;
    place.tile_shift = ROOT_SHIFT;
#if PROGRESSIVE
    place.brick_shift = ROOT_SHIFT;
#endif
    place.summary = uvec2(0u);
    int turns = 0;
    for (;;) {
        ++turns;
        const int found = seek(ray, place, turns);
        if (found != SEEK_OCCUPIED) return found == SEEK_MISSING ? MARCH_MISSING : MARCH_DONE;
        const int voxel_shift = voxel_shift_of(place);
        const ivec3 tile = ray.voxel >> place.tile_shift;
        const ivec3 low = (ray.voxel >> voxel_shift) << voxel_shift;
        const ivec3 brick_low = (ray.voxel >> (voxel_shift + M_SHIFT)) << (voxel_shift + M_SHIFT);
        const float side = float(1 << voxel_shift);
        const float t_in = ray.t;
        Sample s;
        s.slot = place.slot;
        s.voxel = (low - brick_low) >> voxel_shift;
        s.side = side;
        s.centre = vec3(low) + 0.5 * side;
        const bool goes_on = step_over(ray, voxel_shift);
        s.t = 0.5 * (t_in + ray.t);
        s.middle = clamp((ray.origin + ray.direction * s.t - vec3(brick_low)) / side, vec3(0.0),
                         vec3(float(BRICK_M)));
        if (!visit(ray, s) || !goes_on) return MARCH_DONE;
        if (any(notEqual(ray.voxel >> place.tile_shift, tile))) place.slot = -1;
    }
}

// What is left of `transmittance` behind a voxel. Voxels of one surface cover different parts of a pixel, so their
// shares add up instead of multiplying; and from half covered on, no light may leak between them.
float behind(float transmittance, float coverage) { return max(transmittance - min(2.0 * coverage, 1.0), 0.0); }

ivec3 slot_texel(int slot) {
    const ivec3 place = ivec3(slot % pool_slots.x, slot / pool_slots.x % pool_slots.y,
                              slot / (pool_slots.x * pool_slots.y));
    return place * (BRICK_M + 2);
}

float coverage_of(Sample s) {
    const vec4 texel = texelFetch(brick_color, slot_texel(s.slot) + 1 + s.voxel, 0);
#if HAS_COLOR
    return texel.a;
#else
    return texel.r;
#endif
}

// Trilinear fetch at a sample's middle. By hand, because the samplers' own filtering rounds by where in the pool the slot
// lies, and by driver; the brick's border keeps it inside the slot.
vec4 filtered(sampler3D texels, Sample s) {
    const vec3 place = s.middle + 0.5;  // from the border's first texel centre
    const vec3 low = floor(place);
    const vec3 f = place - low;
    const ivec3 p = slot_texel(s.slot) + ivec3(low);
    const vec4 y0 = mix(mix(texelFetch(texels, p, 0), texelFetch(texels, p + ivec3(1, 0, 0), 0), f.x),
                        mix(texelFetch(texels, p + ivec3(0, 1, 0), 0), texelFetch(texels, p + ivec3(1, 1, 0), 0), f.x),
                        f.y);
    const vec4 y1 = mix(mix(texelFetch(texels, p + ivec3(0, 0, 1), 0), texelFetch(texels, p + ivec3(1, 0, 1), 0), f.x),
                        mix(texelFetch(texels, p + ivec3(0, 1, 1), 0), texelFetch(texels, p + ivec3(1, 1, 1), 0), f.x),
                        f.y);
    return mix(y0, y1, f.z);
}

// --- ray states and lists ---

uvec2 pack_voxel(ivec3 v) {
    const uvec3 u = uvec3(v);
    return uvec2(u.x | u.y << 21, u.y >> 11 | u.z << 10);
}
ivec3 unpack_voxel(uvec2 p) {
    return ivec3(p.x & 0x1FFFFFu, p.x >> 21 | (p.y & 0x3FFu) << 11, p.y >> 10 & 0x1FFFFFu);
}

void store_position(inout RayState state, Ray ray) {
    state.voxel_t_weight.xy = pack_voxel(ray.voxel);
    state.voxel_t_weight.z = floatBitsToUint(ray.t);
}
void load_position(inout Ray ray, RayState state) {
    ray.voxel = unpack_voxel(state.voxel_t_weight.xy);
    ray.t = uintBitsToFloat(state.voxel_t_weight.z);
}

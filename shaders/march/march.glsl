// The ray-marcher's one loop. The includer supplies visit(); primary and shadow rays differ only in that.
//
// The tree is walked by restart from the root (kd-restart; Crassin et al. 2008, section 5.1): a ray finds the tile that
// its cone asks for, marches its brick, and starts again behind it. Progress is by integer neighbour steps: every step
// moves one coordinate of `voxel` by at least one in the ray's direction, so no epsilon is needed and no ray can stall.
//
// Needs the defines TREE_N, BRICK_M, MAX_LEVEL (the tree's depth) and HAS_COLOR.
#include "interop/config.h"
#include "interop/bindings.h"
#include "interop/types.h"

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
#define BLOCKS_A_SIDE (BRICK_M / 4)
#define BLOCKS (BLOCKS_A_SIDE * BLOCKS_A_SIDE * BLOCKS_A_SIDE)
#define SUMMARY_WORDS ((BLOCKS + 63) / 64)
#define MASK_WORDS_A_SLOT (SUMMARY_WORDS + BLOCKS)

// A ray meets at most three cells for each voxel across, and may leave a tile as often.
#define STEP_LIMIT (8 * ROOT_SIDE)

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
    bool leaving;         // still inside the surface it started from: what it meets is not counted
    float leaving_end;    // distance at which it has left in any case
};

// A voxel of a brick that a ray crosses.
struct Sample {
    int slot;
    ivec3 voxel;          // in the brick, [0, BRICK_M)
    vec3 middle;          // middle of the chord, brick voxels, [0, BRICK_M]
    float chord;          // length inside the voxel, in sides of the voxel
    float t;              // distance of the middle
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
    ray.leaving = false;
    ray.leaving_end = 0.0;
    return ray;
}

// Puts the ray where it enters the root cube; false when it misses it.
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
    const float t_near = max(max(near.x, near.y), max(near.z, 0.0));
    const float t_far = min(far.x, min(far.y, far.z));
    if (t_near > t_far || t_near >= ray.t_end) return false;
    ray.t = t_near;
    ray.voxel = clamp(ivec3(floor(clamp(ray.origin + ray.direction * t_near, vec3(0.0), side))), ivec3(0),
                      ivec3(ROOT_SIDE - 1));
    return true;
}

// Where the ray leaves the aligned cell of side 1 << shift around its voxel.
float exit_distance(Ray ray, ivec3 low, int shift, out bvec3 leaves) {
    const vec3 bound = vec3(low + ray.positive * (1 << shift));
    const vec3 t = mix((bound - ray.origin) * ray.inverse, vec3(1e30), ray.inert);
    const bool x = t.x <= t.y && t.x <= t.z;
    const bool y = !x && t.y <= t.z;
    leaves = bvec3(x, y, !x && !y);
    return max(min(t.x, min(t.y, t.z)), ray.t);
}

// Steps over the cell to its neighbour; false when the ray has left the root cube or come to its end.
bool step_over(inout Ray ray, ivec3 low, int shift, float t_exit, bvec3 leaves) {
    const ivec3 high = low + (1 << shift) - 1;
    const ivec3 inside = clamp(ivec3(floor(ray.origin + ray.direction * t_exit)), low, high);
    // Rounding must not carry the other coordinates backwards.
    const bvec3 forward = equal(ray.positive, ivec3(1));
    const ivec3 kept = mix(min(inside, ray.voxel), max(inside, ray.voxel), forward);
    const ivec3 beyond = mix(low - 1, high + 1, forward);
    ray.voxel = mix(kept, beyond, leaves);
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

void query(uint entry, uint kind) {
    const uint bit = 2u * entry + kind;
    const uint old = atomicOr(usage[usage_query_offset + bit / 32u], 1u << (bit % 32u));
    if ((old >> (bit % 32u) & 1u) != 0u) return;  // another ray has asked
    const uint place = atomicAdd(counters.queries, 1u);
    if (place < uint(QUERY_CAPACITY)) queries[place] = bit;
}

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

// Marches the brick of the tile around ray.voxel; false when the ray is done.
bool march_brick(inout Ray ray, int slot, int tile_shift) {
    const int voxel_shift = tile_shift - M_SHIFT;
    const ivec3 tile = ray.voxel >> tile_shift;
    const ivec3 tile_low = tile << tile_shift;
    const float side = float(1 << voxel_shift);
    const int first_word = slot * MASK_WORDS_A_SLOT;
    const uvec2 summary = texelFetch(brick_masks, first_word).xy;
    int held = -1;  // the block whose mask is at hand
    uvec2 mask = uvec2(0u);
    touch(slot);
    // A straight line crosses at most 3 M - 2 cells of a brick.
    for (int cell = 0; cell < 3 * BRICK_M; ++cell) {
        const ivec3 b = (ray.voxel - tile_low) >> voxel_shift;
        int empty = empty_block_shift(slot, summary, b >> 2);
        int shift = voxel_shift + 2 + empty;
        if (empty < 0) {
            const ivec3 c = b >> 2;
            const int block = c.x + BLOCKS_A_SIDE * (c.y + BLOCKS_A_SIDE * c.z);
            if (block != held) {
                mask = texelFetch(brick_masks, first_word + SUMMARY_WORDS + block).xy;
                held = block;
            }
            empty = empty_shift_4(mask, b & 3);
            shift = voxel_shift + max(empty, 0);
        }
        const ivec3 low = (ray.voxel >> shift) << shift;
        bvec3 leaves;
        const float t_exit = exit_distance(ray, low, shift, leaves);
        if (empty >= 0) {
            ray.leaving = false;
        } else {
            ray.leaving = ray.leaving && ray.t < ray.leaving_end;
            if (!ray.leaving) {
                Sample s;
                s.slot = slot;
                s.voxel = b;
                s.t = 0.5 * (ray.t + t_exit);
                s.side = side;
                s.chord = (t_exit - ray.t) / side;
                s.middle = clamp((ray.origin + ray.direction * s.t - vec3(tile_low)) / side, vec3(0.0),
                                 vec3(float(BRICK_M)));
                if (!visit(ray, s)) return false;
            }
        }
        if (!step_over(ray, low, shift, t_exit, leaves)) return false;
        if (any(notEqual(ray.voxel >> tile_shift, tile))) return true;
    }
    return true;
}

// Marches until the ray is done, or until it misses a tile: then it has asked for it, and stands where it resumes.
int march(inout Ray ray) {
    for (int step = 0; step < STEP_LIMIT; ++step) {
        const float width = ray.cone_base + ray.cone_slope * ray.t;
        uint entry = 0u;
        uvec4 node = texelFetch(nodes, 0);
        int tile_shift = ROOT_SHIFT;
        int empty = -1;
        for (int level = 0; level < MAX_LEVEL; ++level) {
            if (float(1 << (tile_shift - M_SHIFT)) <= width) break;
            const ivec3 c = (ray.voxel >> (tile_shift - N_SHIFT)) & (TREE_N - 1);
#if TREE_N == 4
            empty = empty_shift_4(node.xy, c);
#else
            empty = empty_shift_2(node.x, c);
#endif
            if (empty >= 0) break;
            if (node.z == 0u) {
                query(entry, QUERY_CHILDREN);
                return MARCH_MISSING;
            }
            entry = node.z + uint(c.x + TREE_N * (c.y + TREE_N * c.z));
            node = texelFetch(nodes, int(entry));
            tile_shift -= N_SHIFT;
        }
        if (empty >= 0) {
            const int shift = tile_shift - N_SHIFT + empty;
            const ivec3 low = (ray.voxel >> shift) << shift;
            bvec3 leaves;
            const float t_exit = exit_distance(ray, low, shift, leaves);
            ray.leaving = false;
            if (!step_over(ray, low, shift, t_exit, leaves)) return MARCH_DONE;
        } else {
            if (node.w == 0u) {
                query(entry, QUERY_BRICK);
                return MARCH_MISSING;
            }
            if (!march_brick(ray, int(node.w) - 1, tile_shift)) return MARCH_DONE;
        }
    }
    atomicAdd(counters.step_limit_hits, 1u);
    return MARCH_DONE;
}

// Opacity of a voxel for the length of the chord in it: the voxel's own is for one side.
float opacity_of(float coverage, float chord) {
    const float transmittance = 1.0 - coverage * (1.0 - FULL_COVERAGE_TRANSMITTANCE);
    return 1.0 - pow(transmittance, max(chord, 0.0));
}

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

// Texture coordinate of a sample's middle; the border keeps a linear fetch inside the brick.
vec3 pool_coordinate(Sample s) {
    return (vec3(slot_texel(s.slot)) + 1.0 + s.middle) / vec3(pool_slots * (BRICK_M + 2));
}

// --- ray states and lists ---

uvec2 pack_voxel(ivec3 v, bool leaving) {
    const uvec3 u = uvec3(v);
    return uvec2(u.x | u.y << 21, u.y >> 11 | u.z << 10 | (leaving ? 0x80000000u : 0u));
}
ivec3 unpack_voxel(uvec2 p) {
    return ivec3(p.x & 0x1FFFFFu, p.x >> 21 | (p.y & 0x3FFu) << 11, p.y >> 10 & 0x1FFFFFu);
}

void store_position(inout RayState state, Ray ray) {
    state.voxel_t_weight.xy = pack_voxel(ray.voxel, ray.leaving);
    state.voxel_t_weight.z = floatBitsToUint(ray.t);
}
void load_position(inout Ray ray, RayState state) {
    const uvec2 packed_voxel = state.voxel_t_weight.xy;
    ray.voxel = unpack_voxel(packed_voxel);
    ray.leaving = (packed_voxel.y & 0x80000000u) != 0u;
    ray.t = uintBitsToFloat(state.voxel_t_weight.z);
}

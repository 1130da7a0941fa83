// Coverage and filtered attributes of the voxels of a brick, for rays.
#include "pool/coverage.glsl"
#include "pool/slab.glsl"

// The transmittance behind a voxel. Voxels of one surface cover different parts of a pixel, so their shares
// add up instead of multiplying; and a voxel that is at least half covered is opaque, so that no light leaks
// between neighbours. If two mips are blended (blend.glsl), `share` is the voxel's weight.
float behind(float transmittance, float coverage, float share) {
    return max(transmittance - share * min(2.0 * coverage, 1.0), 0.0);
}

// Where the attributes of a voxel of the sample's brick and mip are. `v`: place in the mip, border included:
// [-1, MIP_M(mip)].
#if PACKED
struct VoxelPlace {
    int word;    // first word of its record; -1: the voxel is empty
    int record;  // number of its record
};

int record_word(int brick, int record) { return brick + HEAD_WORDS + record * RECORD_WORDS; }

VoxelPlace voxel_place(Sample s, ivec3 v) {
    const GroupBit at = group_bit(v, s.mip);
    const uvec2 occupied = mask_word(s.brick, SUMMARY_WORDS + at.group);
    const int record = int(brick_word(s.brick + HEAD_RANKS + at.group)) + bits_below(occupied, at.bit);
    return VoxelPlace(has_bit(occupied, at.bit) ? record_word(s.brick, record) : -1, record);
}

// As pool/brick_normals.glsl packs them; 0: none.
uint normals_at(VoxelPlace place) { return place.word < 0 ? 0u : brick_word(place.word); }

// Where the marks of a voxel that is in the table are; -1: they are not kept, because the slab tells as much.
int marks_word(int brick, int record) {
    const uvec2 entry = two_brick_words(brick + int(brick_word(brick + HEAD_TABLE)) + 2 * (record >> 5));
    const uint bit = 1u << (record & 31);
    return (entry.x & bit) != 0u ? brick + int(entry.y) + 2 * bitCount(entry.x & (bit - 1u)) : -1;
}

#if HAS_COLOR
// Colour (square root of the linear one) times coverage, and coverage.
vec4 color_at(VoxelPlace place) { return place.word < 0 ? vec4(0.0) : unpackUnorm4x8(brick_word(place.word + 1)); }

float coverage_at(Sample s, VoxelPlace place) { return color_at(place).a; }
#else
float coverage_at(Sample s, VoxelPlace place) {
    if (place.word < 0) return 0.0;
    const int marks = marks_word(s.brick, place.record);
    return marks >= 0 ? coverage_of_marks(two_brick_words(marks)) : coverage_of_slab(unpack_slab(normals_at(place)));
}
#endif
#else
#define VoxelPlace ivec3

ivec3 voxel_place(Sample s, ivec3 v) { return s.texel + 1 + v; }

// Colour (square root of the linear one) times coverage, and coverage. Without colours, coverage alone, in all
// four.
vec4 color_at(ivec3 texel) {
#if HAS_COLOR
    return texelFetch(brick_color, texel, 0);
#else
    return texelFetch(brick_color, texel, 0).rrrr;
#endif
}

float coverage_at(Sample s, ivec3 texel) { return color_at(texel).a; }

uint normals_at(ivec3 texel) { return normal_bits(texelFetch(brick_normal, texel, 0)); }
#endif

float coverage_of_voxel(Sample s) { return coverage_at(s, voxel_place(s, s.voxel)); }

#if MARKS
// What lies in an occupied voxel.
struct Geometry {
    // The finer voxels that the surface meets; all, if the slab tells as much.
    uvec2 marks;
    bool is_marked;
    bool has_slab;
    Slab slab;
};

// `v`: place in the mip, without the border.
Geometry geometry_of(int brick, int mip, ivec3 v) {
    const GroupBit at = inner_group_bit(v, mip);
    const uvec2 occupied = mask_word(brick, SUMMARY_WORDS + at.group);
    const int record = int(brick_word(brick + HEAD_RANKS + at.group)) + bits_below(occupied, at.bit);
    const uint normals = brick_word(record_word(brick, record));
    const int marks = marks_word(brick, record);
    Geometry there;
    there.is_marked = (GEOMETRY & GEOMETRY_MARKS) != 0 && marks >= 0;
    there.marks = there.is_marked ? two_brick_words(marks) : uvec2(0xFFFFFFFFu);
    there.has_slab = (GEOMETRY & GEOMETRY_SLABS) != 0 && has_slab(normals);
    there.slab = unpack_slab(normals);
    return there;
}

// A mark is a solid cell.
float coverage_of(Sample s) { return s.is_mark ? 1.0 : coverage_of_voxel(s); }
#else
float coverage_of(Sample s) { return coverage_of_voxel(s); }
#endif

// The texels around a sample's middle that a filtered fetch mixes. The centres of eight texels are the
// corners of a cube around the middle. Four of them are used: those of the tetrahedron along the cube's
// diagonal that holds the middle. That is as smooth as a trilinear fetch, for half the fetches (tetrahedral
// interpolation: Kasson et al. 1995). The texel of the voxel itself is among them.
struct Corners {
    VoxelPlace low, next, far, high;
    vec4 weights;  // of the four
};

// The weight of the voxel itself, the only one that is surely occupied, must not vanish: so much is added to
// it. The sum of the weights need not be 1.
#define VOXEL_EXTRA_WEIGHT 0.125

// Texels are filtered by hand, because the rounding of the samplers' filter depends on the slot's place in
// the pool and on the driver, and because packed bricks are no textures. The brick's border keeps all corners
// inside the brick.
Corners corners_around(Sample s) {
    const vec3 place = s.middle + 0.5;  // relative to the centre of the border's first texel
    const vec3 f = fract(place);
    const float most = max(f.x, max(f.y, f.z));
    const float least = min(f.x, min(f.y, f.z));
    const float other = max(min(f.x, f.y), min(max(f.x, f.y), f.z));
    const ivec3 up = f.x == most ? ivec3(1, 0, 0) : f.y == most ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
    const ivec3 left_out = f.z == least ? ivec3(0, 0, 1) : f.y == least ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
    const ivec3 low = ivec3(floor(place)) - 1;
    Corners c;
    c.low = voxel_place(s, low);
    c.next = voxel_place(s, low + up);
    c.far = voxel_place(s, low + 1 - left_out);
    c.high = voxel_place(s, low + 1);
    c.weights = vec4(1.0 - most, most - other, other - least, least);
    const ivec3 corner = s.voxel - low;
    c.weights += VOXEL_EXTRA_WEIGHT * vec4(equal(ivec4(corner.x + corner.y + corner.z), ivec4(0, 1, 2, 3)));
    return c;
}

#if HAS_COLOR
vec4 filtered_color(Sample s, Corners c) {
    return c.weights.x * color_at(c.low) + c.weights.y * color_at(c.next) + c.weights.z * color_at(c.far) +
           c.weights.w * color_at(c.high);
}
#endif

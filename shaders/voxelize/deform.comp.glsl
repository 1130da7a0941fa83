// One thread is one vertex of a surface that moves: morph targets, skin, the node's place, and the lattice,
// as scenes/deform.cpp, scenes/snapshot.h and Grid::lattice_from_world do, operation by operation, so that
// positions have the same bits. `precise` keeps the driver from fusing operations and from changing their
// order. Positions need only sums and products of doubles, which drivers round alike. Normals need quotients
// and roots too, and may differ in the last step.
#include "interop/deform.h"
#include "interop/grid.h"
#include "interop/surface.h"
#include "common/thread.glsl"

layout(std430, binding = SSBO_SURFACE_POSITIONS) restrict writeonly buffer PositionBlock { int positions[]; };
#if NORMALS
layout(std430, binding = SSBO_SURFACE_ATTRIBUTES) restrict writeonly buffer AttributeBlock {
    SurfaceAttributes attributes[];
};
#endif
layout(std430, binding = SSBO_DEFORM_VERTICES) restrict readonly buffer VertexBlock { uvec4 vertices[]; };
layout(std430, binding = SSBO_DEFORM_VECTORS) restrict readonly buffer VectorBlock { float vectors[]; };
layout(std430, binding = SSBO_DEFORM_INFLUENCES) restrict readonly buffer InfluenceBlock {
    DeformInfluences influences[];
};
layout(std430, binding = SSBO_DEFORM_ITEMS) restrict readonly buffer ItemBlock { DeformItem items[]; };
layout(std430, binding = SSBO_DEFORM_MATRICES) restrict readonly buffer MatrixBlock { double matrices[]; };
layout(std430, binding = SSBO_DEFORM_FRAME) restrict buffer FrameBlock {
    DeformHeader header;
    DeformTarget targets[];
};

uniform uint count;

struct Affine {
    dvec3 x, y, z, origin;
};

dvec3 column_of(uint matrix, uint column) {
    const uint first = 12u * matrix + 3u * column;
    return dvec3(matrices[first], matrices[first + 1u], matrices[first + 2u]);
}

Affine affine(uint matrix) {
    return Affine(column_of(matrix, 0u), column_of(matrix, 1u), column_of(matrix, 2u), column_of(matrix, 3u));
}

vec3 vector_at(uint number) {
    return vec3(vectors[3u * number], vectors[3u * number + 1u], vectors[3u * number + 2u]);
}

// The weighted sum of the joints' matrices; the matrix of the first joint if all weights are 0.
Affine skin_matrix(DeformItem item, uint vertex) {
    precise Affine sum = Affine(dvec3(0.0), dvec3(0.0), dvec3(0.0), dvec3(0.0));
    const uint first = item.first_influence + vertex * item.set_count;
    for (uint i = 0u; i < 4u * item.set_count; ++i) {
        const float weight = influences[first + i / 4u].weights[i % 4u];
        if (weight == 0.0) {
            if (i == 0u) sum = affine(item.first_joint);
            break;
        }
        const double w = double(weight);
        const uint joint = influences[first + i / 4u].joints[i % 4u / 2u] >> (16u * (i % 2u)) & 0xFFFFu;
        const Affine matrix = affine(item.first_joint + joint);
        sum.x = sum.x + w * matrix.x;
        sum.y = sum.y + w * matrix.y;
        sum.z = sum.z + w * matrix.z;
        sum.origin = sum.origin + w * matrix.origin;
    }
    return sum;
}

dvec3 transformed(Affine m, dvec3 p) {
    precise dvec3 sum = (m.x * p.x + m.y * p.y) + (m.z * p.z + m.origin);
    return sum;
}

vec3 morphed_position(DeformItem item, uint vertex, vec3 rest) {
    precise vec3 position = rest;
    for (uint t = 0u; t < item.target_count; ++t) {
        const DeformTarget target = targets[item.first_target + t];
        if (target.weight == 0.0 || target.first_position == DEFORM_NONE) continue;
        position = position + target.weight * vector_at(target.first_position + vertex);
    }
    return position;
}

// A position that the buffer of positions cannot hold is moved to just past the range that it can: a triangle
// of such vertices still misses the root cube on the same side, and find_far.comp.glsl finds those that do
// not miss it.
ivec3 lattice_position(dvec3 world) {
    const dvec3 origin = dvec3(header.origin[0], header.origin[1], header.origin[2]);
    precise dvec3 units = (world - origin) * header.scale;
    precise dvec3 nearest = floor(units + 0.5LF);
    const double side = double(1 << LATTICE_BITS);
    if (!all(lessThanEqual(abs(units), dvec3(LATTICE_WORLD_LIMIT)))) {  // false for NaN
        atomicAdd(header.lost, 1u);
        return ivec3(0);
    }
    if (any(lessThan(nearest, dvec3(-side))) || any(greaterThan(nearest, dvec3(2.0LF * side)))) {
        atomicAdd(header.stray, 1u);
    }
    return ivec3(clamp(nearest, dvec3(-side - 1.0LF), dvec3(2.0LF * side + 1.0LF)));
}

#if NORMALS
vec3 unit(dvec3 v) {
    precise double length_2 = v.x * v.x + v.y * v.y + v.z * v.z;
    precise double its_length = sqrt(length_2);
    return its_length > 0.0LF && !isinf(its_length) ? vec3(v / its_length) : vec3(0.0);
}

vec3 morphed_normal(DeformItem item, uint vertex) {
    precise vec3 normal = vector_at(item.first_normal + vertex);
    for (uint t = 0u; t < item.target_count; ++t) {
        const DeformTarget target = targets[item.first_target + t];
        if (target.weight == 0.0 || target.first_normal == DEFORM_NONE) continue;
        normal = normal + target.weight * vector_at(target.first_normal + vertex);
    }
    const bool is_deformed = item.target_count > 0u || item.first_joint != DEFORM_NONE;
    return is_deformed ? unit(dvec3(normal)) : normal;
}

// A normal transformed by the matrix of cofactors, which unlike the inverse exists for every matrix.
vec3 skinned_normal(Affine m, vec3 normal) {
    dvec3 x = cross(m.y, m.z);
    dvec3 y = cross(m.z, m.x);
    dvec3 z = cross(m.x, m.y);
    const double side = dot(x, m.x) < 0.0LF ? -1.0LF : 1.0LF;
    return unit(side * (x * double(normal.x) + y * double(normal.y) + z * double(normal.z)));
}

uint snorm_16(double value) {
    const double scaled = value * 32767.0LF;
    const double whole = floor(abs(scaled));
    const int nearest = int(whole) + (abs(scaled) - whole >= 0.5LF ? 1 : 0);
    return uint(scaled < 0.0LF ? -nearest : nearest) & 0xFFFFu;
}

// A unit normal by the octahedral map, as encode_normal() of voxelizer/surface/surface.cpp.
uint encode_normal(dvec3 normal) {
    const double sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    if (!(sum > 0.0LF) || isinf(sum)) return 0u;
    dvec2 e = normal.xy / sum;
    if (normal.z < 0.0LF) {
        const dvec2 folded = 1.0LF - abs(e.yx);
        e = dvec2(e.x >= 0.0LF ? folded.x : -folded.x, e.y >= 0.0LF ? folded.y : -folded.y);
    }
    const uint bits = snorm_16(e.x) | snorm_16(e.y) << 16;
    return bits != 0u ? bits : 1u;
}
#endif

void main() {
    const uint thread = thread_index();
    if (thread >= count) return;
    const uvec4 at_rest = vertices[thread];
    const DeformItem item = items[at_rest.w];
    const uint vertex = thread - item.first_vertex;
    const bool is_skinned = item.first_joint != DEFORM_NONE;
    Affine place;
    if (is_skinned) {
        place = skin_matrix(item, vertex);
    } else {
        place = affine(item.matrix);
    }
    const dvec3 world = transformed(place, dvec3(morphed_position(item, vertex, uintBitsToFloat(at_rest.xyz))));
    const ivec3 position = lattice_position(world);
    positions[3u * thread] = position.x;
    positions[3u * thread + 1u] = position.y;
    positions[3u * thread + 2u] = position.z;
#if NORMALS
    if (item.first_normal == DEFORM_NONE) return;
    const vec3 normal = morphed_normal(item, vertex);
    if (is_skinned) {
        attributes[thread].normal = encode_normal(dvec3(skinned_normal(place, normal)));
        return;
    }
    const dvec3 x = column_of(item.matrix + 1u, 0u);
    const dvec3 y = column_of(item.matrix + 1u, 1u);
    const dvec3 z = column_of(item.matrix + 1u, 2u);
    attributes[thread].normal =
        encode_normal(x * double(normal.x) + y * double(normal.y) + z * double(normal.z));
#endif
}

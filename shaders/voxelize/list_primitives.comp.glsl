// One thread is one triangle of a batch: it puts the triangle into the list of its kind if the triangle's box
// touches the tile.
#include "interop/voxelize.h"
#include "voxelize/raster_lists.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_VOXEL_SUBSET) restrict readonly buffer VoxelSubset { uint voxel_subset[]; };
uniform uint first;  // number of the first triangle, or its place in the subset
uniform uint count;  // number of triangles
uniform int has_subset;
uniform ivec3 tile_low;   // low corner of the tile, lattice units
uniform ivec3 tile_size;  // size of the tile, voxels
uniform int voxel_shift;
uniform int split_far;    // 1: far triangles have a list

void list(uint kind, uvec3 vertices, uint triangle) {
    const uint corners = corners_of(kind);
    const uint place = atomicAdd(raster_lists[kind], 1u);
    for (uint i = 0u; i < corners; ++i) raster_lists[first_vertex(kind) + place * corners + i] = vertices[i];
    raster_lists[triangle_place(kind, place)] = triangle;
}

// The two end vertices of a triangle without area.
uvec2 ends(uvec3 vertices, ivec3 a, ivec3 b, ivec3 c) {
    const ivec3 ab = abs(b - a), bc = abs(c - b), ca = abs(a - c);
    const int length_ab = ab.x + ab.y + ab.z, length_bc = bc.x + bc.y + bc.z, length_ca = ca.x + ca.y + ca.z;
    if (length_ab >= max(length_bc, length_ca)) return vertices.xy;
    return length_bc >= length_ca ? vertices.yz : vertices.zx;
}

void main() {
    const uint thread = thread_index();
    if (thread >= count) return;
    const uint triangle = has_subset != 0 ? voxel_subset[first + thread] : first + thread;
    const uvec3 vertices = surface_triangles[triangle].vertices;
    // Coordinates are relative to the tile from here on.
    const ivec3 a = surface_position(vertices.x) - tile_low;
    const ivec3 b = surface_position(vertices.y) - tile_low;
    const ivec3 c = surface_position(vertices.z) - tile_low;
    const ivec3 low = min(min(a, b), c) >> voxel_shift;
    const ivec3 high = max(max(a, b), c) >> voxel_shift;
    // A triangle one voxel past the size counts, because a triangle on the tile's end touches its last voxel.
    if (any(greaterThan(low, tile_size)) || any(lessThan(high, ivec3(-1)))) return;

    const ivec3 ab = b - a, ac = c - a;
    // Exact, because all numbers are whole and under 2^53.
    const dvec3 normal = cross(dvec3(ab), dvec3(ac));
    if (all(equal(ab, ivec3(0))) && all(equal(ac, ivec3(0)))) {
        list(RASTER_POINTS, vertices, triangle);
    } else if (all(equal(normal, dvec3(0.0LF)))) {
        list(RASTER_SEGMENTS, uvec3(ends(vertices, a, b, c), 0u), triangle);
    } else {
        const bool far = any(lessThan(low, ivec3(-RASTER_FAR_VOXELS))) ||
                         any(greaterThan(high, tile_size + RASTER_FAR_VOXELS));
        list(far && split_far != 0 ? RASTER_FAR : RASTER_TRIANGLES, vertices, triangle);
    }
}

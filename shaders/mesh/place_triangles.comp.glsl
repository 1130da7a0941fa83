// One thread is one triangle of a batch: it computes the triangle's plane and coordinates in this view.
#include "interop/mesh.h"
#include "mesh/mesh_view.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_MESH_TRIANGLES) restrict writeonly buffer MeshTriangleBlock {
    MeshTriangle mesh_triangles[];
};

uniform uint first;  // number in the chunk of the batch's first triangle
uniform uint count;  // triangles of the batch

void main() {
    const uint i = thread_index();
    if (i >= count) return;
    const uvec3 vertices = surface_triangles[first + i].vertices;
    const ivec3 a = surface_position(vertices.x), b = surface_position(vertices.y), c = surface_position(vertices.z);
    // Exact: lattice coordinates have at most 26 bits.
    const dvec3 ab = dvec3(b - a), ac = dvec3(c - a);
    const dvec3 normal = cross(ab, ac);
    const double size_squared = dot(normal, normal);
    const dvec3 corner = from_eye(a);
    const dvec3 along = dvec3(dot(mesh_view.along, corner), dot(mesh_view.along, from_eye(b)),
                              dot(mesh_view.along, from_eye(c)));
    MeshTriangle placed;
    placed.normal = placed.second = placed.third = vec3(0.0);
    placed.height = placed.padding = 0.0;
    placed.corner = vec3(corner);
    placed.nearest = float(min(along.x, min(along.y, along.z)));
    placed.furthest = float(max(along.x, max(along.y, along.z)));
    if (size_squared > 0.0lf) {
        const dvec3 unit_normal = normal / sqrt(size_squared);
        placed.normal = vec3(unit_normal);
        placed.height = float(dot(unit_normal, corner));
        const double scale = 1.0lf / (size_squared * mesh_view.lattice_unit);
        placed.second = vec3(cross(ac, normal) * scale);
        placed.third = vec3(cross(normal, ab) * scale);
    }
    mesh_triangles[i] = placed;
}

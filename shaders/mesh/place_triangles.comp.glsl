// One thread is one triangle of a batch: its plane and its coordinates as this view sees them.
#include "mesh/mesh_view.glsl"
#include "voxelize/surface.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = SSBO_MESH_TRIANGLES) restrict writeonly buffer MeshTriangleBlock {
    MeshTriangle mesh_triangles[];
};

uniform uint first;  // of the batch, in the chunk
uniform uint count;

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= count) return;
    const uvec3 vertices = surface_triangles[first + i].vertices_material.xyz;
    const ivec3 a = surface_position(vertices.x), b = surface_position(vertices.y), c = surface_position(vertices.z);
    // Exact: lattice coordinates have at most 26 bits.
    const dvec3 ab = dvec3(b - a), ac = dvec3(c - a);
    const dvec3 normal = cross(ab, ac);
    const double size_squared = dot(normal, normal);
    const dvec3 corner = from_eye(a);
    const dvec3 along = dvec3(dot(mesh_view.along.xyz, corner), dot(mesh_view.along.xyz, from_eye(b)),
                              dot(mesh_view.along.xyz, from_eye(c)));
    MeshTriangle placed = MeshTriangle(vec4(0.0), vec4(vec3(corner), float(min(along.x, min(along.y, along.z)))),
                                       vec4(0.0, 0.0, 0.0, float(max(along.x, max(along.y, along.z)))), vec4(0.0));
    if (size_squared > 0.0lf) {
        const dvec3 unit_normal = normal / sqrt(size_squared);
        placed.plane = vec4(vec3(unit_normal), float(dot(unit_normal, corner)));
        const double scale = 1.0lf / (size_squared * mesh_view.place.w);
        placed.second.xyz = vec3(cross(ac, normal) * scale);
        placed.third.xyz = vec3(cross(normal, ab) * scale);
    }
    mesh_triangles[i] = placed;
}

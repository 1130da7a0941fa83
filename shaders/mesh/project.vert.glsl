// Puts a vertex of a mesh where pixel_ray() sees it. Rows go downwards, so front faces are clockwise.
#include "interop/surface.h"
#include "mesh/mesh_view.glsl"

layout(location = ATTRIBUTE_POSITION) in ivec3 position;  // lattice units

invariant gl_Position;

void main() {
    const dvec3 p = from_eye(position);
    const double w = dot(mesh_view.along, p) + mesh_view.skipped;
    // Clipping at -w <= z is clipping at w >= nearest. z has no other use, because fragments compute their
    // distance.
    const double z = w - 2.0lf * mesh_view.nearest;
    const dvec2 moved = w * dvec2(mesh_view.moved_across, mesh_view.moved_down);
    gl_Position = vec4(dvec4(dvec2(dot(mesh_view.across, p), dot(mesh_view.down, p)) + moved, z, w));
}

// Finds the first and the last face of a proxy at each pixel, and the number of front faces less that of back
// faces. Blending does it, so the order of the triangles does not matter.
#include "mesh/mesh_fragment.glsl"

layout(location = 0) out vec2 span;    // (first, -last): blending keeps the least of both
layout(location = 1) out float faces;  // blending sums: 1 per front face, -1 per back face

void main() {
    const MeshHit hit = hit_of(mesh_triangles[gl_PrimitiveID], pixel_ray(ivec2(gl_FragCoord.xy)));
    span = vec2(hit.t, -hit.t);
    faces = gl_FrontFacing ? 1.0 : -1.0;
}

// The first and the last face of a proxy at each pixel, and how many more fronts than backs there are: all by
// blending, so in any order.
#include "mesh/mesh_fragment.glsl"

layout(location = 0) out vec2 span;    // least of both is kept: (first, -last)
layout(location = 1) out float faces;  // sum

void main() {
    const MeshHit hit = hit_of(mesh_triangles[gl_PrimitiveID], pixel_ray(ivec2(gl_FragCoord.xy)));
    span = vec2(hit.t, -hit.t);
    faces = gl_FrontFacing ? 1.0 : -1.0;
}

// gl_FragCoord.w is 1 / z of light space. Blending keeps the greatest in the first target (the closest faces)
// and the least in the second (the furthest ones): each texel is right in any order of the triangles, with
// all bits of a float.
#include "shadow/material.glsl"

layout(location = 0) out float closest;
layout(location = 1) out float furthest;

in vec2 surface_texcoord;
in float surface_alpha;

void main() {
    if (is_hole(surface_texcoord, surface_alpha)) discard;
    closest = gl_FragCoord.w;
    furthest = gl_FragCoord.w;
}

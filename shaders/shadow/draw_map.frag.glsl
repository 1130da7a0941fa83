// Writes the inverse depth 1 / z of light space, which is gl_FragCoord.w. Blending keeps the greatest value
// in the first target (the closest faces) and the least in the second (the furthest faces), so each texel is
// right in any order of the triangles, with all bits of a float.
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

// Where a pixel's ray may run inside a proxy.
#include "interop/mesh.h"
layout(binding = TEXTURE_PROXY_SPAN) uniform sampler2D proxy_span;
layout(binding = TEXTURE_PROXY_FACES) uniform sampler2D proxy_faces;
uniform int proxy_first_row;  // of the picture, in these textures

// First and last distance; the first is not less than the last where the ray never runs. More backs than
// fronts before the eye: it is inside. `pixel` in the band.
vec2 proxy_span_at(ivec2 pixel) {
    const ivec2 place = pixel + ivec2(0, view.first_row - proxy_first_row);
    const vec2 span = texelFetch(proxy_span, place, 0).xy;
    const bool starts_inside = texelFetch(proxy_faces, place, 0).r < -0.5;
    return vec2(starts_inside ? 0.0 : max(span.x, 0.0), -span.y);
}

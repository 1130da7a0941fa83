// The part of a pixel's ray that lies inside a proxy.
#include "interop/mesh.h"
layout(binding = TEXTURE_PROXY_SPAN) uniform sampler2D proxy_span;
layout(binding = TEXTURE_PROXY_FACES) uniform sampler2D proxy_faces;
uniform int proxy_first_row;  // row of the picture that is row 0 of these textures

// First and last distance; the first is not less than the last if the ray misses the proxy. If a pixel has
// more back faces than front faces, the eye is inside the proxy. `pixel` counts from the band's first.
vec2 proxy_span_at(ivec2 pixel) {
    const ivec2 place = pixel + ivec2(0, view.first_row - proxy_first_row);
    const vec2 span = texelFetch(proxy_span, place, 0).xy;
    const bool starts_inside = texelFetch(proxy_faces, place, 0).r < -0.5;
    return vec2(starts_inside ? 0.0 : max(span.x, 0.0), -span.y);
}

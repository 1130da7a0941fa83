// The share of the light that one micro-patch hides from one receiver point (Atty et al. 2005, section 3.4):
// the patch, projected back onto the light, meets it in a rectangle. Blending adds the shares of all patches.
#include "interop/shadow_map.h"

layout(binding = TEXTURE_SHADOW_RECEIVERS) uniform sampler2D receivers;
// Scale and offset to tangents over the light's width and height.
uniform vec4 tangents_from_pixel;

flat in vec4 patch_edges;  // tangents over the light's width and height: low.xy, high.xy
flat in float patch_inverse_depth;

layout(location = 0) out float hidden;

void main() {
    const float receiver = texelFetch(receivers, ivec2(gl_FragCoord.xy), 0).x;
    const vec2 here = gl_FragCoord.xy * tangents_from_pixel.xy + tangents_from_pixel.zw;
    // A point of the patch projects to (its tangents - here) / (difference of inverse depths) in the light's
    // plane.
    const float gap = patch_inverse_depth - receiver;
    const vec4 edges = clamp((patch_edges - here.xyxy) / max(gap, 1e-30) + 0.5, 0.0, 1.0);
    hidden = receiver > 0.0 && gap > 0.0 ? (edges.z - edges.x) * (edges.w - edges.y) : 0.0;
}

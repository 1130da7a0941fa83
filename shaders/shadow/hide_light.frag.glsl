// The share of the light that one micro-patch hides from one receiver point (Atty et al. 2005, section 3.4): the patch,
// projected back onto the light, meets it in a rectangle. Blending adds the shares of all patches.
#include "interop/bindings.h"
#include "shadow/window.glsl"

layout(binding = TEXTURE_SHADOW_RECEIVERS) uniform sampler2D receivers;
uniform vec4 receiver_window;
uniform vec2 light_half;
uniform int receiver_size;

flat in vec4 patch_edges;
flat in float patch_inverse_depth;

layout(location = 0) out float hidden;

void main() {
    const float receiver = texelFetch(receivers, ivec2(gl_FragCoord.xy), 0).x;
    const vec2 here = tangents_at(receiver_window, gl_FragCoord.xy, float(receiver_size));
    // A point of the patch projects to (its tangents - here) / (difference of inverse depths) in the light's plane.
    const float gap = patch_inverse_depth - receiver;
    const vec2 width = max(2.0 * light_half * gap, 1e-30);
    const vec4 edges = clamp((patch_edges - here.xyxy) / width.xyxy + 0.5, 0.0, 1.0);
    hidden = receiver > 0.0 && gap > 0.0 ? (edges.z - edges.x) * (edges.w - edges.y) : 0.0;
}

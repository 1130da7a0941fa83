// One thread is one texel of the soft shadow map: the share of the light that is left. With two passes, the
// one that hides more counts (Atty et al. 2005, section 3.5). Reprojections that overlap may sum to more than
// the whole light.
#include "interop/shadow_map.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = TEXTURE_SHADOW_HIDDEN) uniform sampler2D hidden_by_closest;
layout(binding = TEXTURE_SHADOW_HIDDEN_FURTHEST) uniform sampler2D hidden_by_furthest;
layout(binding = IMAGE_SHADOW_LEVEL, r32f) uniform writeonly image2D visible;

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(visible)))) return;
    float hidden = texelFetch(hidden_by_closest, texel, 0).x;
#if SHADOW_PASSES == 2
    hidden = max(hidden, texelFetch(hidden_by_furthest, texel, 0).x);
#endif
    imageStore(visible, texel, vec4(clamp(1.0 - hidden, 0.0, 1.0)));
}

// One thread is one texel of a level of the pyramid of the furthest receivers: it holds the least inverse
// depth of four texels of the finer level. The base is the receiver map, on a square whose side is a power of
// two; a texel without a receiver is SHADOW_NONE.
#include "interop/shadow_map.h"

layout(local_size_x = 8, local_size_y = 8) in;
#if REDUCE_BASE
layout(binding = TEXTURE_SHADOW_RECEIVERS) uniform sampler2D receivers;
#else
layout(binding = TEXTURE_SHADOW_PYRAMID) uniform sampler2D finer;
uniform int finer_level;
#endif
layout(binding = IMAGE_SHADOW_LEVEL, r32f) uniform writeonly image2D level;

#if REDUCE_BASE
float furthest(ivec2 texel) {
    if (any(greaterThanEqual(texel, textureSize(receivers, 0)))) return SHADOW_NONE;
    const float w = texelFetch(receivers, texel, 0).x;
    return w > 0.0 ? w : SHADOW_NONE;
}
#else
float fetch(ivec2 texel) {
    return texelFetch(finer, texel, finer_level).x;
}
float furthest(ivec2 texel) {
    const ivec2 low = 2 * texel;
    return min(min(fetch(low), fetch(low + ivec2(1, 0))), min(fetch(low + ivec2(0, 1)), fetch(low + 1)));
}
#endif

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(level)))) return;
    imageStore(level, texel, vec4(furthest(texel)));
}

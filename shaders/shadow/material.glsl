// The base colour of what is drawn. Its texture is white where a material has none.
#include "interop/shadow_map.h"

layout(binding = TEXTURE_SHADOW_BASE_COLOR) uniform sampler2D base_color_texture;
uniform vec4 base_color;
uniform float alpha_cutoff;  // 0 = no alpha mask

// Decided on the finest level: coarser ones would thin a mask out.
bool is_hole(vec2 texcoord, float alpha) {
    return textureLod(base_color_texture, texcoord, 0.0).a * base_color.a * alpha < alpha_cutoff;
}

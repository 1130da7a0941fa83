// The base colour of the triangles that are drawn. The texture is white if the material has none.
#include "interop/shadow_map.h"

layout(binding = TEXTURE_SHADOW_BASE_COLOR) uniform sampler2D base_color_texture;
uniform vec4 base_color;
uniform float alpha_cutoff;  // 0 = no alpha mask

// Whether the alpha mask cuts a point away. Decided on the finest level, because coarser levels would thin a
// mask out.
bool is_hole(vec2 texcoord, float alpha) {
    return textureLod(base_color_texture, texcoord, 0.0).a * base_color.a * alpha < alpha_cutoff;
}

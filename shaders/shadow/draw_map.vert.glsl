// Projects occluders or receivers to a map as the centre of the light sees them.
#include "interop/shadow_map.h"

layout(location = ATTRIBUTE_SHADOW_POSITION) in vec3 position;
layout(location = ATTRIBUTE_SHADOW_COLOR) in vec4 color;
layout(location = ATTRIBUTE_SHADOW_TEXCOORD) in vec2 texcoord;

uniform mat4 light_from_mesh;
uniform vec4 window;
uniform float near_distance;

out vec2 surface_texcoord;
out float surface_alpha;

void main() {
    const vec3 p = vec3(light_from_mesh * vec4(position, 1.0));
    const vec2 across = (2.0 * p.xy - (window.xy + window.zw) * p.z) / (window.zw - window.xy);
    // So clipping at -w <= z is clipping at p.z >= near_distance, and there is no far plane.
    gl_Position = vec4(across, -near_distance, p.z);
    surface_texcoord = texcoord;
    surface_alpha = color.a;
}

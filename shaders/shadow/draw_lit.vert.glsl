// Projects the scene to a camera's picture, and passes on the position of each vertex in light space.
#include "interop/shadow_map.h"

layout(location = ATTRIBUTE_SHADOW_POSITION) in vec3 position;
layout(location = ATTRIBUTE_SHADOW_NORMAL) in vec3 normal;
layout(location = ATTRIBUTE_SHADOW_COLOR) in vec4 color;
layout(location = ATTRIBUTE_SHADOW_TEXCOORD) in vec2 texcoord;

uniform mat4 clip_from_mesh;
uniform mat4 light_from_mesh;

out vec3 surface_position;  // relative to the mesh's origin, world axes
out vec3 surface_normal;    // 0 = none
out vec4 surface_color;
out vec2 surface_texcoord;
out vec3 light_position;    // light space

void main() {
    gl_Position = clip_from_mesh * vec4(position, 1.0);
    surface_position = position;
    surface_normal = normal;
    surface_color = color;
    surface_texcoord = texcoord;
    light_position = vec3(light_from_mesh * vec4(position, 1.0));
}

// Projects the soft shadow map onto the scene: the share of the light at a receiver's point is that of the
// map. Points outside the map's window, or behind the light, are lit.
#include "interop/shadow_map.h"
#include "common/sky_light.glsl"
#include "shadow/material.glsl"
#include "shadow/window.glsl"

layout(binding = TEXTURE_SHADOW_RECEIVERS) uniform sampler2D receivers;
layout(binding = TEXTURE_SHADOW_VISIBLE) uniform sampler2D visible_map;
uniform vec4 receiver_window;
uniform float near_distance;
uniform int is_receiver;
uniform vec3 eye;        // relative to the mesh's origin, world axes
uniform vec3 light;
uniform vec4 light_color;  // w: ambient

in vec3 surface_position;
in vec3 surface_normal;
in vec4 surface_color;
in vec2 surface_texcoord;
in vec3 light_position;

layout(location = 0) out vec4 color;
// Visible share, -1 if this is no receiver; distance from the eye.
layout(location = 1) out vec2 visible_distance;

// The visible share, interpolated between those of the four nearest texels that have a receiver: beside a
// receiver's edge the other texels hold nothing about it.
float visible_at(vec3 p) {
    const float size = float(textureSize(visible_map, 0).x);
    const vec2 texels = texels_at(receiver_window, p.xy / max(p.z, near_distance), size);
    if (p.z < near_distance || any(lessThan(texels, vec2(0.0))) || any(greaterThan(texels, vec2(size)))) return 1.0;
    const vec2 low = floor(texels - 0.5);
    const vec2 part = texels - 0.5 - low;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        const ivec2 step_to = ivec2(i & 1, i >> 1);
        const ivec2 texel = clamp(ivec2(low) + step_to, ivec2(0), ivec2(int(size) - 1));
        const vec2 weights = mix(1.0 - part, part, vec2(step_to));
        if (texelFetch(receivers, texel, 0).x > 0.0)
            sum += weights.x * weights.y * vec2(texelFetch(visible_map, texel, 0).x, 1.0);
    }
    return sum.y > 0.0 ? sum.x / sum.y : 1.0;
}

vec3 facing_normal(vec3 to_eye) {
    // Derivatives must be taken before any branch, so that all fragments of the quad compute them.
    const vec3 flat_normal = cross(dFdx(surface_position), dFdy(surface_position));
    const vec3 normal = dot(surface_normal, surface_normal) > 0.0 ? surface_normal : flat_normal;
    return normalize(dot(normal, to_eye) < 0.0 ? -normal : normal);
}

void main() {
    const vec3 normal = facing_normal(eye - surface_position);
    const vec4 base = texture(base_color_texture, surface_texcoord) * base_color * surface_color;
    if (is_hole(surface_texcoord, surface_color.a)) discard;
    const float visible = is_receiver != 0 ? visible_at(light_position) : 1.0;
    const float facing = max(dot(normal, normalize(light - surface_position)), 0.0);
    const float sky = light_color.w * sky_share(normal);
    color = vec4(base.rgb * light_color.rgb * (facing * visible * (1.0 - light_color.w) + sky), 1.0);
    visible_distance = vec2(is_receiver != 0 ? visible : -1.0, distance(eye, surface_position));
}

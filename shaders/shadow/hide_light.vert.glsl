// Draws penumbra extents as quads on the soft shadow map: one instance per micro-patch, a strip of four
// vertices.
#include "interop/shadow_map.h"
#include "shadow/window.glsl"

layout(location = ATTRIBUTE_SHADOW_PATCH) in uvec4 patch_words;  // MicroPatch

uniform vec4 occluder_window;
uniform int occluder_size;
uniform int receiver_size;
uniform vec2 light_half;

flat out vec4 patch_edges;  // tangents over the light's width and height: low.xy, high.xy
flat out float patch_inverse_depth;

vec2 halves(uint word) {
    return vec2(word & 0xFFFFu, word >> 16);
}

void main() {
    const vec2 texel = halves(patch_words.x);
    patch_edges = vec4(tangents_at(occluder_window, texel, float(occluder_size)),
                       tangents_at(occluder_window, texel + 1.0, float(occluder_size))) /
                  (2.0 * light_half).xyxy;
    patch_inverse_depth = uintBitsToFloat(patch_words.y);
    const vec2 high = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    const vec2 corner = mix(halves(patch_words.z), halves(patch_words.w), high);
    gl_Position = vec4(corner / float(receiver_size) * 2.0 - 1.0, 0.0, 1.0);
}

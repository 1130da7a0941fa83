// The picture of the band, a word per pixel: a colour (RGBA8) or, if the light is shown (SHOW_LIGHT), the
// bits of a float. Until a pixel with a mesh is written, its word holds the light that reaches its voxels.
#include "interop/march.h"

layout(std430, binding = SSBO_PICTURE) buffer PictureBlock { uint picture[]; };

uint pixel_index(ivec2 pixel) { return uint(pixel.y * view.width + pixel.x); }
ivec2 pixel_at(uint index) { return ivec2(int(index) % view.width, int(index) / view.width); }

// Linear to sRGB (IEC 61966-2-1).
vec3 srgb_from_linear(vec3 c) {
    const vec3 clamped = clamp(c, 0.0, 1.0);
    return mix(12.92 * clamped, 1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055,
               greaterThan(clamped, vec3(0.0031308)));
}

void store_color(uint index, vec3 color, float alpha) {
    picture[index] = packUnorm4x8(vec4(srgb_from_linear(color), alpha));
}
void store_background(uint index) { picture[index] = view.background_pixel; }

// Stores a number instead of a colour.
void store_number(uint index, float number) { picture[index] = floatBitsToUint(number); }

// The light that reaches the voxels of a pixel, kept while shadow rays start from the mesh behind them.
#define LIGHT_NOT_KNOWN (-1.0)
void keep_light_on_voxels(uint index, float light) { store_number(index, light); }
float kept_light_on_voxels(uint index) { return uintBitsToFloat(picture[index]); }

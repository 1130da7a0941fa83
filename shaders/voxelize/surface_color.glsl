// Base colour and normal of a surface at a point of one of its triangles.
#include "interop/surface.h"
#include "voxelize/material.glsl"
#include "voxelize/octahedral.glsl"
#include "voxelize/surface_attributes.glsl"

// Within 7e-5 of the value of the curve, and so much nearer than a step of 8 bits. A power takes longer, and
// each driver rounds it in its own way. With s the root of (c + 0.055) / 1.055, the curve is s^4.8.
vec3 linear_from_srgb(vec3 c) {
    const vec3 s = sqrt((c + 0.055) / 1.055);
    const vec3 s2 = s * s;
    const vec3 rest = ((((-0.892102596 * s + 3.51451407) * s - 5.69235555) * s + 4.94093543) * s - 2.60847749) * s +
                      1.73741956;  // s^-0.2
    return mix(c / 12.92, s2 * s2 * s * rest, greaterThan(c, vec3(0.04045)));
}

// A point on a triangle, by the weights of its vertices.
struct SurfacePoint {
    uvec3 vertices;
    vec3 weights;
};

vec3 normal_at(SurfacePoint p, vec3 triangle_normal) {
    const uvec3 packed_normals = uvec3(attributes[p.vertices.x].normal, attributes[p.vertices.y].normal,
                                       attributes[p.vertices.z].normal);
    if (any(equal(packed_normals, uvec3(0u)))) return triangle_normal;
    const vec3 n = p.weights.x * decode_normal(packed_normals.x) + p.weights.y * decode_normal(packed_normals.y) +
                   p.weights.z * decode_normal(packed_normals.z);
    const float size = length(n);
    return size > 1e-6 ? n / size : triangle_normal;
}

// A texel's number along one axis, by glTF's wrap modes (MATERIAL_WRAP_*).
uint wrapped(float coordinate, uint size, uint mode) {
    const float n = float(size);
    if (mode == 2u) return uint(clamp(floor(coordinate * n), 0.0, n - 1.0));
    float unit = fract(coordinate);
    if (mode == 1u && mod(floor(coordinate), 2.0) == 1.0) unit = 1.0 - unit;
    return uint(clamp(floor(unit * n), 0.0, n - 1.0));
}

// Texel alphas and vertex alphas are compared as whole numbers (SurfaceMaterial.alpha_threshold).
bool passes(float texel_alpha, float vertex_alpha, SurfaceMaterial material) {
    return uint(round(texel_alpha * 255.0)) * uint(round(vertex_alpha * 255.0 * 256.0)) >= material.alpha_threshold;
}

vec4 nearest_texel(SurfaceMaterial material, vec2 uv) {
    const uint x = wrapped(uv.x, material.width, wrap_s_of(material));
    const uint y = wrapped(uv.y, material.height, wrap_t_of(material));
    return unpackUnorm4x8(surface_texel(material.texel_offset + y * material.width + x));
}

// The two texels along one axis that a box of at most one texel's width touches, and the share of the second
// one.
struct TexelPair {
    uvec2 numbers;
    float share;
};

TexelPair texel_pair(float coordinate, float width, uint size, uint mode) {
    const float n = float(size);
    // The first period: far from 0 a float has no fractions left.
    float unit = mode == 2u ? clamp(coordinate, 0.0, 1.0) : fract(coordinate);
    if (mode == 1u && mod(floor(coordinate), 2.0) == 1.0) unit = 1.0 - unit;
    const float place = unit * n - 0.5;  // relative to the first texel's middle
    const float low = floor(place);
    TexelPair pair;
    // The border between both lies half a texel behind the first one's middle.
    pair.share = clamp((place - low - 0.5) / max(width, 1e-6) + 0.5, 0.0, 1.0);
    const float first = mode == 0u && low < 0.0 ? n - 1.0 : low;
    const float second = mode == 0u && low + 1.0 >= n ? 0.0 : low + 1.0;
    pair.numbers = uvec2(clamp(vec2(first, second), 0.0, n - 1.0));
    return pair;
}

// What an alpha is multiplied by before it is compared with a cutoff, or with 1, for the sum of a point's
// weights is rounded.
#define ALPHA_SLACK 1.00001

#ifndef MEAN_MOST_TAPS
#define MEAN_MOST_TAPS 8  // boxes that a long footprint is cut in
#endif

// A mip level of a material's texture.
struct MipLevel {
    uint offset;  // first texel in TEXTURE_SURFACE_TEXELS
    uvec2 size;
    bool finest;
};

// The finest level whose texels are as large as a footprint of this width in texels of level 0.
MipLevel level_of_width(SurfaceMaterial material, float width) {
    MipLevel level = MipLevel(material.texel_offset, uvec2(material.width, material.height), true);
    if (material.mip_offset == 0u) return level;
    // The least k with width <= 2^k.
    const int wanted = width <= 1.0 ? 0 : findMSB(uint(min(ceil(width), 16777216.0)) - 1u) + 1;
    for (int k = 0; k < wanted && max(level.size.x, level.size.y) > 1u; ++k) {
        level.offset = level.finest ? material.mip_offset : level.offset + level.size.x * level.size.y;
        level.size = max(level.size >> 1, uvec2(1u));
        level.finest = false;
    }
    return level;
}

// Linear colour of a texel times the share of it that counts, and that share. A mask leaves out what does not
// pass.
vec4 kept_texel(SurfaceMaterial material, MipLevel level, uvec2 place, float vertex_alpha) {
    const vec4 texel = unpackUnorm4x8(surface_texel(level.offset + place.y * level.size.x + place.x));
    float kept = 1.0;
    if (is_masked(material))
        kept = !level.finest ? texel.a : passes(texel.a, vertex_alpha, material) ? 1.0 : 0.0;
    return vec4(kept * linear_from_srgb(texel.rgb), kept);
}

// Mean over a box of at most about a texel of the level.
vec4 box_mean(SurfaceMaterial material, MipLevel level, vec2 uv, vec2 width, float vertex_alpha) {
    const vec2 texels_across = min(width * vec2(level.size), 1.0);
    const TexelPair x = texel_pair(uv.x, texels_across.x, level.size.x, wrap_s_of(material));
    const TexelPair y = texel_pair(uv.y, texels_across.y, level.size.y, wrap_t_of(material));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        const bvec2 second = bvec2((i & 1) != 0, (i & 2) != 0);
        const float weight = (second.x ? x.share : 1.0 - x.share) * (second.y ? y.share : 1.0 - y.share);
        const uvec2 place = uvec2(second.x ? x.numbers.y : x.numbers.x, second.y ? y.numbers.y : y.numbers.x);
        if (weight > 0.0) sum += weight * kept_texel(material, level, place, vertex_alpha);
    }
    return sum;
}

// How many times finer than the shorter side of a footprint the texels of its mip level are: more texels, and
// a smaller error where a texture changes slowly.
#ifndef MEAN_FINENESS
#define MEAN_FINENESS 1
#endif

// Mean of a texture over a parallelogram of these two sides, given as texture coordinates, around a point:
// linear colour times the share that a mask keeps, and that share. The shorter side chooses the mip level,
// and the longer one is cut in boxes about as long; if it is longer than MEAN_MOST_TAPS boxes, the level
// becomes coarser.
vec4 mean_texel(SurfaceMaterial material, vec2 uv, vec2 side_a, vec2 side_b, float vertex_alpha) {
    const vec2 size = vec2(material.width, material.height);
    const float a = length(side_a * size);
    const float b = length(side_b * size);
    const vec2 long_side = a < b ? side_b : side_a;
    const vec2 short_side = a < b ? side_a : side_b;
    const float longer = min(max(a, b), 16777216.0);
    const float shorter = min(min(a, b), 16777216.0);
    const float width = max(shorter / float(MEAN_FINENESS), longer / float(MEAN_MOST_TAPS));
    // Coarser levels know what passes for the highest vertex alpha alone.
    const MipLevel level = level_of_width(material, is_masked(material) && vertex_alpha * ALPHA_SLACK < 1.0 ? 0.0 : width);
    const float most = max(width, 1.0);
    const int long_taps = int(clamp(ceil(longer / most), 1.0, float(MEAN_MOST_TAPS)));
    const int short_taps = int(clamp(ceil(shorter / most), 1.0, float(MEAN_FINENESS)));
    const vec2 box = max(abs(long_side) / float(long_taps), abs(short_side) / float(short_taps));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < long_taps * short_taps; ++i) {
        const vec2 along = (float(i % long_taps) + 0.5) / float(long_taps) * long_side - 0.5 * long_side;
        const vec2 across = (float(i / long_taps) + 0.5) / float(short_taps) * short_side - 0.5 * short_side;
        sum += box_mean(material, level, uv + along + across, box, vertex_alpha);
    }
    return sum / float(long_taps * short_taps);
}

vec2 texcoord_at(SurfacePoint p) {
    return p.weights.x * attribute_texcoord(p.vertices.x) + p.weights.y * attribute_texcoord(p.vertices.y) +
           p.weights.z * attribute_texcoord(p.vertices.z);
}

vec4 vertex_color_at(SurfacePoint p) {
    return p.weights.x * attribute_color(p.vertices.x) + p.weights.y * attribute_color(p.vertices.y) +
           p.weights.z * attribute_color(p.vertices.z);
}

// The part of a surface around a point that a colour is the mean of: a parallelogram. Its sides are given as
// changes of the weights of the second and third vertex.
struct Footprint {
    vec2 side_a, side_b;
};

// The texture's part in a colour: a mean over the footprint. If the mask hides all of it, the nearest texel.
vec3 texture_color(SurfaceMaterial material, vec2 uv, vec2 side_a, vec2 side_b, float vertex_alpha) {
    const vec4 mean = mean_texel(material, uv, side_a, side_b, vertex_alpha);
    return mean.a > 0.0 ? mean.rgb / mean.a : linear_from_srgb(nearest_texel(material, uv).rgb);
}

// Mean base colour over a footprint around a point.
vec3 color_over(SurfacePoint p, Footprint footprint, SurfaceMaterial material) {
    const vec4 vertex_color = vertex_color_at(p);
    vec3 color = material.base_color.rgb * vertex_color.rgb;
    if (material.width == 0u) return color;
    const vec2 first = attribute_texcoord(p.vertices.x);
    const vec2 second = attribute_texcoord(p.vertices.y) - first;
    const vec2 third = attribute_texcoord(p.vertices.z) - first;
    const vec2 side_a = footprint.side_a.x * second + footprint.side_a.y * third;
    const vec2 side_b = footprint.side_b.x * second + footprint.side_b.y * third;
    return color * texture_color(material, texcoord_at(p), side_a, side_b, vertex_color.a);
}

float alpha_at(SurfacePoint p, SurfaceMaterial material) {
    float alpha = material.base_color.a * vertex_color_at(p).a;
    if (material.width != 0u) alpha *= nearest_texel(material, texcoord_at(p)).a;
    return alpha;
}

// Base colour and normal of a surface at a point of one of its triangles.
#include "interop/surface.h"
#include "voxelize/octahedral.glsl"
#include "voxelize/surface_attributes.glsl"

vec3 linear_from_srgb(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
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

vec4 nearest_texel(SurfaceMaterial material, vec2 uv) {
    const uint x = wrapped(uv.x, material.width, material.flags >> MATERIAL_WRAP_S_SHIFT & 3u);
    const uint y = wrapped(uv.y, material.height, material.flags >> MATERIAL_WRAP_T_SHIFT & 3u);
    return unpackUnorm4x8(texels[material.texel_offset + y * material.width + x]);
}

vec2 texcoord_at(SurfacePoint p) {
    return p.weights.x * attribute_texcoord(p.vertices.x) + p.weights.y * attribute_texcoord(p.vertices.y) +
           p.weights.z * attribute_texcoord(p.vertices.z);
}

vec4 vertex_color_at(SurfacePoint p) {
    return p.weights.x * attribute_color(p.vertices.x) + p.weights.y * attribute_color(p.vertices.y) +
           p.weights.z * attribute_color(p.vertices.z);
}

vec3 color_at(SurfacePoint p, SurfaceMaterial material) {
    vec3 color = material.base_color.rgb * vertex_color_at(p).rgb;
    if (material.width != 0u) color *= linear_from_srgb(nearest_texel(material, texcoord_at(p)).rgb);
    return color;
}

// What an alpha is multiplied by before it is compared with a cutoff, for the sum of a point's weights is
// rounded, and an alpha that equals the cutoff passes.
#define ALPHA_SLACK 1.00001

float alpha_at(SurfacePoint p, SurfaceMaterial material) {
    float alpha = material.base_color.a * vertex_color_at(p).a;
    if (material.width != 0u) alpha *= nearest_texel(material, texcoord_at(p)).a;
    return alpha;
}

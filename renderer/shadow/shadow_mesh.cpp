#include "renderer/shadow/shadow_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include <glm/gtc/matrix_transform.hpp>

#include "gl/buffer_offset.h"
#include "gl/limits.h"
#include "shaders/interop/shadow_map.h"
#include "voxelizer/surface/texture_mips.h"

namespace cairn::renderer {
namespace {

struct Vertex {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};     ///< 0: no normal; the triangle's is used
    glm::u16vec4 color{65535};  ///< linear
    glm::vec2 texcoord{0.0F};   ///< after KHR_texture_transform
};

GLint wrap_mode(scenes::Wrap wrap) {
    switch (wrap) {
        case scenes::Wrap::repeat:
            return GL_REPEAT;
        case scenes::Wrap::mirrored_repeat:
            return GL_MIRRORED_REPEAT;
        case scenes::Wrap::clamp_to_edge:
            break;
    }
    return GL_CLAMP_TO_EDGE;
}

/// Texels that a sampler mixes for a pixel that sees a surface at a low angle, where the driver can.
constexpr float wanted_anisotropy = 8.0F;

/// @param levels  RGBA8 in a word, level after level.
gl::TextureHandle make_texture(const glm::ivec2& size, std::span<const std::uint32_t> levels,
                               scenes::Wrap wrap_s, scenes::Wrap wrap_t) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    gl::TextureHandle texture(id);
    glTextureStorage2D(id, GLsizei(std::bit_width(unsigned(std::max(size.x, size.y)))), GL_SRGB8_ALPHA8,
                       size.x, size.y);
    glm::ivec2 side = size;
    std::size_t first = 0;
    for (GLint level = 0; first < levels.size(); ++level) {
        glTextureSubImage2D(id, level, 0, 0, side.x, side.y, GL_RGBA, GL_UNSIGNED_BYTE, &levels[first]);
        first += std::size_t(side.x) * std::size_t(side.y);
        side = voxelizer::coarser_mip_size(side);
    }
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    const float most_anisotropy = gl::query_limits().anisotropy;
    if (most_anisotropy > 1.0F)
        glTextureParameterf(id, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(wanted_anisotropy, most_anisotropy));
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, wrap_mode(wrap_s));
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, wrap_mode(wrap_t));
    return texture;
}

/// The lowest texel alpha, 0 to 255, that passes a material's mask where vertices have alpha 1.
std::uint32_t lowest_passing_alpha(const scenes::Material& material) {
    if (material.alpha_mode != scenes::AlphaMode::mask || !(material.alpha_cutoff > 0.0F)) return 0;
    const double least = std::ceil(255.0 * double(material.alpha_cutoff) / double(material.base_color.a));
    return least <= 255.0 ? std::uint32_t(least) : 256U;
}

/// The matrix that transforms normals if `m` transforms points, whatever the scales of `m`. It keeps the
/// orientation, and is 0 if `m` flattens space.
glm::dmat3 cofactors(const glm::dmat3& m) {
    const glm::dmat3 c(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], c[0]) < 0.0 ? -c : c;
}

void append_vertices(const scenes::Scene& scene, const scenes::Item& item, const glm::dvec3& origin,
                     std::vector<Vertex>& vertices) {
    const scenes::Primitive& primitive = *item.primitive;
    const glm::dmat3 normal_from_mesh = cofactors(glm::dmat3(item.world_from_mesh));
    const glm::mat3 uv_from_mesh = primitive.material >= 0
                                       ? scene.materials[std::size_t(primitive.material)].uv_from_mesh
                                       : glm::mat3(1.0F);
    for (std::size_t i = 0; i < item.vertex_count(); ++i) {
        Vertex& vertex = vertices.emplace_back();
        vertex.position = glm::vec3(item.world(i) - origin);
        if (!item.normals.empty()) {
            const glm::dvec3 normal = normal_from_mesh * glm::dvec3(item.normals[i]);
            const double length = glm::length(normal);
            if (std::isfinite(length) && length > 0.0) vertex.normal = glm::vec3(normal / length);
        }
        if (!primitive.colors.empty()) vertex.color = primitive.colors[i];
        if (!primitive.texcoords.empty())
            vertex.texcoord = glm::vec2(uv_from_mesh * glm::vec3(primitive.texcoords[i], 1.0F));
    }
}

}  // namespace

ShadowMesh::ShadowMesh(const scenes::Scene& scene, const scenes::Snapshot& snapshot) {
    // Floats hold more of a point when they count from the middle.
    if (!snapshot.bounds.empty()) origin_ = 0.5 * (snapshot.bounds.low + snapshot.bounds.high);
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    for (const scenes::Item& item : snapshot.items) {
        const scenes::Primitive& primitive = *item.primitive;
        if (primitive.topology != scenes::Topology::triangles || primitive.indices.empty()) continue;
        add_draw(scene, primitive, indices.size());
        const auto base = std::uint32_t(vertices.size());
        for (const std::uint32_t index : primitive.indices)
            indices.push_back(base + index);
        append_vertices(scene, item, origin_, vertices);
    }
    triangle_count_ = indices.size() / 3;
    vertices_ = gl::Buffer::of(std::span<const Vertex>(vertices), "vertices of a shadow map");
    indices_ = gl::Buffer::of(std::span<const std::uint32_t>(indices), "triangles of a shadow map");
    texture_places_.clear();
    bind_attributes();
}

void ShadowMesh::add_draw(const scenes::Scene& scene, const scenes::Primitive& primitive,
                          std::size_t first_index) {
    Draw draw{.first_index = first_index, .index_count = primitive.indices.size()};
    int texture = -1;
    std::uint32_t lowest_alpha = 0;
    if (primitive.material >= 0) {
        const scenes::Material& material = scene.materials[std::size_t(primitive.material)];
        draw.base_color = material.base_color;
        if (material.alpha_mode == scenes::AlphaMode::mask) draw.alpha_cutoff = material.alpha_cutoff;
        lowest_alpha = lowest_passing_alpha(material);
        texture = material.texture;
        if (texture >= 0 && scene.textures[std::size_t(texture)].image < 0) texture = -1;
    }
    draw.texture = texture_of(scene, texture, texture >= 0 ? lowest_alpha : 0);
    draws_.push_back(draw);
}

std::size_t ShadowMesh::texture_of(const scenes::Scene& scene, int number, std::uint32_t lowest_alpha) {
    const auto [place, is_new] = texture_places_.try_emplace({number, lowest_alpha}, textures_.size());
    if (!is_new) return place->second;
    if (number < 0) {
        constexpr std::array<std::uint32_t, 1> white = {0xFFFFFFFFU};
        textures_.push_back(make_texture(glm::ivec2(1), white, scenes::Wrap::repeat, scenes::Wrap::repeat));
        return place->second;
    }
    const scenes::Texture& texture = scene.textures[std::size_t(number)];
    const scenes::Image& image = scene.images[std::size_t(texture.image)];
    const glm::ivec2 size(image.width, image.height);
    std::vector<std::uint32_t> texels(std::size_t(size.x) * std::size_t(size.y));
    std::memcpy(texels.data(), image.rgba.data(), texels.size() * sizeof(texels[0]));
    textures_.push_back(make_texture(size, voxelizer::filled_levels(texels, size, lowest_alpha),
                                     texture.wrap_s, texture.wrap_t));
    return place->second;
}

void ShadowMesh::bind_attributes() {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    vertex_array_ = gl::VertexArrayHandle(id);
    glVertexArrayVertexBuffer(id, 0, vertices_.id(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(id, indices_.id());
    const auto add = [id](GLuint attribute, GLint size, GLenum type, GLboolean normalized,
                          std::size_t offset) {
        glEnableVertexArrayAttrib(id, attribute);
        glVertexArrayAttribFormat(id, attribute, size, type, normalized, GLuint(offset));
        glVertexArrayAttribBinding(id, attribute, 0);
    };
    add(ATTRIBUTE_SHADOW_POSITION, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
    add(ATTRIBUTE_SHADOW_NORMAL, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, normal));
    add(ATTRIBUTE_SHADOW_COLOR, 4, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(Vertex, color));
    add(ATTRIBUTE_SHADOW_TEXCOORD, 2, GL_FLOAT, GL_FALSE, offsetof(Vertex, texcoord));
}

void ShadowMesh::draw(const gl::Program& program) const {
    glBindVertexArray(vertex_array_.id());
    for (const Draw& draw : draws_) {
        program.set("base_color", draw.base_color);
        program.set("alpha_cutoff", draw.alpha_cutoff);
        glBindTextureUnit(TEXTURE_SHADOW_BASE_COLOR, textures_[draw.texture].id());
        glDrawElements(GL_TRIANGLES, GLsizei(draw.index_count), GL_UNSIGNED_INT,
                       gl::buffer_offset(draw.first_index * sizeof(std::uint32_t)));
    }
}

glm::mat4 ShadowMesh::from_mesh(const glm::dmat4& from_world) const {
    return glm::mat4(glm::translate(from_world, origin_));
}

}  // namespace cairn::renderer

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

/// The triangles of a snapshot on the GPU, to be rasterized for shadow maps and pictures. Lines and points,
/// which have no area, are left out.
class ShadowMesh {
public:
    /// Neither the scene nor the snapshot is needed afterwards.
    /// @throws Error  Fault::memory if the mesh does not fit.
    ShadowMesh(const scenes::Scene& scene, const scenes::Snapshot& snapshot);

    /// Draws all triangles with the program in use. Sets its base_color and alpha_cutoff for each material,
    /// and binds the material's texture (shaders/shadow/material.glsl).
    void draw(const gl::Program& program) const;

    /// The point of the world that the mesh's positions count from.
    [[nodiscard]] glm::dvec3 origin() const { return origin_; }
    /// Turns a matrix for points of the world into one for positions of this mesh.
    [[nodiscard]] glm::mat4 from_mesh(const glm::dmat4& from_world) const;
    [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }

private:
    struct Draw {
        std::size_t first_index = 0;
        std::size_t index_count = 0;
        glm::vec4 base_color{1.0F};
        float alpha_cutoff = 0.0F;
        std::size_t texture = 0;  ///< into textures_
    };

    /// Place in textures_ of a texture as a mask with this lowest alpha sees it; of a white one if the number
    /// is -1.
    std::size_t texture_of(const scenes::Scene& scene, int number, std::uint32_t lowest_alpha);
    void add_draw(const scenes::Scene& scene, const scenes::Primitive& primitive, std::size_t first_index);
    void bind_attributes();

    glm::dvec3 origin_{0.0};
    std::size_t triangle_count_ = 0;
    std::vector<Draw> draws_;
    std::vector<gl::TextureHandle> textures_;
    /// By number of the scene's texture, and lowest alpha; only while the mesh is made.
    std::map<std::pair<int, std::uint32_t>, std::size_t> texture_places_;
    gl::Buffer vertices_;
    gl::Buffer indices_;
    gl::VertexArrayHandle vertex_array_;
};

}  // namespace cairn::renderer

#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/shadow/shadow_mesh.h"
#include "renderer/shadow/soft_shadow_map.h"

namespace cairn::renderer {

/// The pinhole view of a projected picture.
struct ProjectionView {
    int width = 512;
    int height = 512;
    glm::dvec3 eye{0.0};
    glm::dmat4 clip_from_world{1.0};  ///< y up, z from -1 (near) to 1
    glm::vec3 background{0.0F};       ///< linear
    glm::vec3 light_color{1.0F};      ///< linear; the light shines from its centre, with no falloff
    float ambient = 0.25F;            ///< light from everywhere, as a share of the light's own
};

/// Row after row, pixel (0, 0) at the top left.
struct ProjectedPixels {
    std::vector<std::uint8_t> rgba;  ///< sRGB-encoded; alpha 0 where nothing is
    std::vector<float> visible;      ///< share of the light according to the map; -1: not on a receiver
    std::vector<float> distance;     ///< distance from the eye; infinite: nothing there
};

/// Draws occluders and receivers, and projects the soft shadow map onto the receivers (Atty et al. 2005,
/// section 3.1). Occluders take no shadow.
class ShadowProjection {
public:
    explicit ShadowProjection(const gl::ShaderSource& shaders = {});

    /// @param map  as its last compute() left it, for these two meshes.
    [[nodiscard]] ProjectedPixels draw(const ProjectionView& view, const SoftShadowMap& map,
                                       const ShadowMesh& occluders, const ShadowMesh& receivers) const;

private:
    void draw_mesh(const ProjectionView& view, const SoftShadowMap& map, const ShadowMesh& mesh,
                   bool is_receiver) const;

    gl::Program program_;
};

}  // namespace cairn::renderer

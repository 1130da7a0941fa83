#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glad/gl.h>
#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "optics/light.h"
#include "renderer/shadow/shadow_mesh.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::bench {

inline void delete_sampler(GLuint id) {
    glDeleteSamplers(1, &id);
}

enum class PcfFilter : std::uint8_t {
    fixed,     ///< taps a texel apart: a soft edge of the same width everywhere
    penumbra,  ///< as wide as the penumbra that the mean depth of what blocks the light says (Fernando 2005)
};

/// Biases are those of glPolygonOffset.
struct PcfOptions {
    int map_size = 1024;  ///< texels a side
    PcfFilter filter = PcfFilter::fixed;
    int kernel = 3;  ///< taps an axis, each filtered by the sampler; as many again look for what blocks
    float slope_bias = 2.0F;     ///< of a texel; a fixed filter takes it times the texels that it reaches
    float constant_bias = 4.0F;  ///< steps of a depth of 24 bits
};

/// A shadow map with percentage-closer filtering, as most renderers have it today: a depth map from the
/// light's middle, fitted to what throws shadows; slope-scaled and constant bias, a sampler that compares and
/// filters; and its soft variant. Needs the context that was current at its construction.
///
/// Based on: Reeves, Salesin, Cook, "Rendering Antialiased Shadows with Depth Maps", 1987; Fernando,
/// "Percentage-Closer Soft Shadows", 2005; for the soft variant, taps are compared with the receiver's plane:
/// Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", 2006.
class PcfShadow {
public:
    /// @param scene     with `snapshot`: what goes into the map
    /// @param casters   of it, what the map is fitted to; elsewhere all is lit
    /// @param points    world: where the shadow is wanted
    /// @param normals   one a point, unit, to the side that is lit
    /// @throws Error  Fault::usage for a light that is not in front of all casters; Fault::memory when it
    /// does
    ///                not fit.
    PcfShadow(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const scenes::Snapshot& casters,
              const optics::Light& light, std::span<const glm::dvec3> points,
              std::span<const glm::dvec3> normals);

    struct Result {
        double milliseconds = 0.0;  ///< of the map and its evaluation, from an idle driver to an idle driver
        std::vector<float> shares;  ///< of the light, [0, 1], one a point
    };
    [[nodiscard]] Result shadow(const PcfOptions& options);

private:
    struct Map {
        gl::TextureHandle depths;
        gl::FramebufferHandle target;
    };
    void fit(const scenes::Snapshot& snapshot, const scenes::Snapshot& casters, const optics::Light& light);
    void make_samplers();
    [[nodiscard]] const Map& map_of(int size);
    void draw(const Map& map, const PcfOptions& options) const;
    void evaluate(const Map& map, const PcfOptions& options) const;

    std::shared_ptr<renderer::ShadowMesh> mesh_;
    glm::dmat4 light_from_world_{1.0};  ///< the light looks along +z
    bool is_perspective_ = true;
    glm::dvec2 low_{-1.0}, high_{1.0};  ///< of the map: x / z and y / z, or x and y
    double near_ = 1.0, far_ = 2.0;
    glm::dvec2 half_{0.0};  ///< of the light; at infinity, the tangent of its angle
    std::size_t count_ = 0;
    gl::Buffer points_, normals_, shares_;
    gl::Program draw_program_, fixed_program_, penumbra_program_;
    gl::Handle<delete_sampler> comparing_, plain_;
    std::map<int, Map> maps_;
};

}  // namespace cairn::bench

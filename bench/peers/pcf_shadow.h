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
    /// Taps are a texel apart: a soft edge of the same width everywhere.
    fixed,
    /// Taps span the penumbra, estimated from the mean depth of the blockers (Fernando 2005).
    penumbra,
};

/// Biases are those of glPolygonOffset.
struct PcfOptions {
    int map_size = 1024;  ///< texels per side
    PcfFilter filter = PcfFilter::fixed;
    /// Taps per axis, each filtered by the sampler. PcfFilter::penumbra takes as many again to find blockers.
    int kernel = 3;
    /// Slope bias per texel. PcfFilter::fixed multiplies it by the texels that the filter reaches.
    float slope_bias = 2.0F;
    /// Constant bias in steps of a 24-bit depth.
    float constant_bias = 4.0F;
};

/// A shadow map with percentage-closer filtering, as most renderers have it today: a depth map from the
/// light's middle, fitted to the casters; slope-scaled and constant bias; a sampler that compares and
/// filters. And its soft variant. Needs the context that was current at its construction.
///
/// Based on: Reeves, Salesin, Cook, "Rendering Antialiased Shadows with Depth Maps", 1987; Fernando,
/// "Percentage-Closer Soft Shadows", 2005; for the soft variant, taps are compared with the receiver's plane:
/// Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", 2006.
class PcfShadow {
public:
    /// @param scene     the scene of `snapshot`, which is drawn into the map
    /// @param casters   the part of the snapshot that the map is fitted to; points outside the map are lit
    /// @param points    points whose shadow is wanted, in the world
    /// @param normals   unit normals, one per point, to its lit side
    /// @throws Error  Fault::usage if the light is not in front of all casters; Fault::memory if the scene
    /// does not fit.
    PcfShadow(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const scenes::Snapshot& casters,
              const optics::Light& light, std::span<const glm::dvec3> points,
              std::span<const glm::dvec3> normals);

    struct Result {
        /// Time of the map and of its evaluation, from an idle driver to an idle driver.
        double milliseconds = 0.0;
        /// Share of the light per point, in [0, 1].
        std::vector<float> shares;
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
    glm::dvec2 low_{-1.0}, high_{1.0};  ///< window of the map: x / z and y / z, or x and y
    double near_ = 1.0, far_ = 2.0;
    /// Half sides of the light; at infinity, tangent of its angle.
    glm::dvec2 half_{0.0};
    std::size_t count_ = 0;
    gl::Buffer points_, normals_, shares_;
    gl::Program draw_program_, fixed_program_, penumbra_program_;
    gl::Handle<delete_sampler> comparing_, plain_;
    std::map<int, Map> maps_;
};

}  // namespace cairn::bench

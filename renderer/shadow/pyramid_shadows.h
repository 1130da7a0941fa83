#pragma once

#include <memory>

#include "gl/shader_source.h"
#include "renderer/shadow/shadow_base.h"

namespace cairn::renderer {

/// Pictures of rasterized surfaces with shadow rays through the xy-reduced pyramid of the surfaces' voxels,
/// all of one size (Forest et al. 2009, section 3.1). Nothing is kept from one moment to the next, so scenes
/// may move (voxelizer/surface/moving_surface.h). Light, samples, shading and the start of rays are those of
/// Renderer with Mix::voxels_hidden.
///
/// The level of detail of a view and ShadowQuality::pixel_error are ignored, because voxels have one size.
/// Cones are refused. Everything that is shown casts and receives shadows. ShadowTimes::shadow_ms is
/// `trace_ms`.
class PyramidShadows final : public ShadowRenderer {
public:
    /// The scene and the snapshot are needed afterwards only with a motion.
    /// @throws Error  Fault::usage if the resolution is out of range, or if a node of the snapshot is no
    ///                caster or no receiver; Fault::memory if the scene does not fit.
    explicit PyramidShadows(const ShadowScene& scene, const PyramidShadowOptions& options = {},
                            const gl::ShaderSource& shaders = {});
    PyramidShadows(const PyramidShadows&) = delete;
    PyramidShadows& operator=(const PyramidShadows&) = delete;
    PyramidShadows(PyramidShadows&&) = delete;
    PyramidShadows& operator=(PyramidShadows&&) = delete;
    ~PyramidShadows() override;

    [[nodiscard]] ShadowPicture render(const View& view, const ShadowRequest& request = {}) override;
    void move_to(double seconds) override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer

#pragma once

#include <cstddef>
#include <memory>

#include "gl/shader_source.h"
#include "renderer/renderer.h"
#include "renderer/shadow/column_mask.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

struct PyramidShadowOptions {
    int resolution = 512;  ///< voxels across the scene: a power of two, 8 to 2048
    ColumnMask mask = ColumnMask::adaptive;
};

/// Of the last frame, by the wall clock from an idle driver to an idle driver. What a frame did not have to
/// do took no time.
struct PyramidShadowStatistics {
    double move_ms = 0.0;       ///< moving the vertices
    double voxelize_ms = 0.0;   ///< their voxels
    double pyramid_ms = 0.0;    ///< all levels
    double raster_ms = 0.0;     ///< the receivers
    double trace_ms = 0.0;      ///< the shadow rays and their shading
    double milliseconds = 0.0;  ///< all of these, and reading the picture
    int passes = 0;             ///< of shadow rays, in all bands of the picture
    std::size_t pyramid_bytes = 0;
};

/// Pictures of rasterized surfaces with shadow rays through the xy-reduced pyramid of their own voxels, all
/// of one size (Forest et al. 2009, section 3.1). Nothing is kept from one moment to the next, so scenes may
/// move. Light, samples, shading and the start of rays are those of Renderer with Mix::voxels_hidden.
///
/// Needs the context that was current at its construction.
class PyramidShadowRenderer {
public:
    /// One moment. The scene and the snapshot are not needed afterwards.
    /// @throws Error  Fault::usage for a resolution that is none; Fault::memory when it does not fit.
    PyramidShadowRenderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                          const PyramidShadowOptions& options = {}, const gl::ShaderSource& shaders = {});

    /// A scene that moves (voxelizer/surface/moving_surface.h), at `when.seconds` first. It must outlive the
    /// renderer.
    /// @param bounds  hold it at all times that will be asked for (scenes::bounds_over_animation): what is
    ///                outside casts no shadow.
    PyramidShadowRenderer(const scenes::Scene& scene, const scenes::When& when, const scenes::Bounds& bounds,
                          const PyramidShadowOptions& options = {}, const gl::ShaderSource& shaders = {});
    PyramidShadowRenderer(PyramidShadowRenderer&&) noexcept;
    PyramidShadowRenderer& operator=(PyramidShadowRenderer&&) noexcept;
    PyramidShadowRenderer(const PyramidShadowRenderer&) = delete;
    PyramidShadowRenderer& operator=(const PyramidShadowRenderer&) = delete;
    ~PyramidShadowRenderer();

    /// @throws Error  Fault::usage when it was made for one moment.
    void move_to(double seconds);

    /// The picture depends on the view and the moment alone. The level of detail does
    /// not count, and cones are rays: voxels have one size.
    /// @throws Error  Fault::usage for a view that is none.
    [[nodiscard]] optics::Image render(const View& view);
    /// Of the same rays what arrives of the light.
    [[nodiscard]] optics::LightShares light_shares(const View& view);

    [[nodiscard]] const PyramidShadowStatistics& statistics() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace cairn::renderer

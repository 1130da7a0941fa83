#pragma once

#include <cstdint>
#include <memory>

#include "gl/shader_source.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/renderer.h"
#include "renderer/shadow/shadow_base.h"

/// Shadows by several methods behind one face: pictures, shares of the light, and times.
///
///     const auto shadows = make_shadow_renderer(ShadowMethod::pyramid, {scene, snapshot});
///     const ShadowPicture picture = shadows->render(view);
namespace cairn::renderer {

enum class ShadowMethod : std::uint8_t {
    /// Rays or cones from rasterized surfaces through the tree of voxels, which is produced as rays ask for
    /// it (Forest et al. 2009, section 3.1; Crassin et al. 2008). ShadowQuality has their limits. For scenes
    /// of one moment; everything casts and receives shadows. ShadowTimes::shadow_ms is that of the last
    /// frame.
    voxel,
    /// Rays from rasterized surfaces through an xy-reduced pyramid of voxels of one size, built for each
    /// moment (renderer/shadow/pyramid_shadows.h). Everything that is shown casts and receives shadows.
    /// ShadowTimes::shadow_ms is `trace_ms`.
    pyramid,
    /// Soft shadow maps after Atty et al. 2005 (renderer/shadow/map_shadows.h), for rectangular lights: some
    /// nodes cast shadows on others. ShadowTimes::shadow_ms is that of the map, on the driver's clock.
    soft_shadow_map,
};

/// Options of all methods. Those of other methods than the chosen one are not read.
struct ShadowOptions {
    TreeOptions tree = {};              ///< for ShadowMethod::voxel
    RendererOptions renderer = {};      ///< for ShadowMethod::voxel
    PyramidShadowOptions pyramid = {};  ///< for ShadowMethod::pyramid
    SoftShadowOptions map = {};         ///< for ShadowMethod::soft_shadow_map
};

/// @throws Error  Fault::usage if an option is out of range, or if the method does not support the casters,
///                the receivers or the motion, with a way out; Fault::memory if the scene does not fit.
[[nodiscard]] std::unique_ptr<ShadowRenderer> make_shadow_renderer(ShadowMethod method,
                                                                   const ShadowScene& scene,
                                                                   const ShadowOptions& options = {},
                                                                   const gl::ShaderSource& shaders = {});

}  // namespace cairn::renderer

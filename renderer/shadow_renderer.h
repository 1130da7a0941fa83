#pragma once

#include <cstdint>
#include <memory>

#include "gl/shader_source.h"
#include "renderer/pool/tree_options.h"
#include "renderer/renderer_options.h"
#include "renderer/shadow/shadow_base.h"
#include "renderer/shadow/shadow_options.h"

/// Shadows by several methods behind one face: pictures, shares of the light, and times.
///
///     const auto shadows = make_shadow_renderer(ShadowMethod::pyramid, {scene, snapshot});
///     const ShadowPicture picture = shadows->render(view);
namespace cairn::renderer {

enum class ShadowMethod : std::uint8_t {
    /// Rays or cones from rasterized surfaces through the tree of voxels, which is produced as rays ask for
    /// it (Forest et al. 2009, section 3.1; Crassin et al. 2008). ShadowQuality tells their limits. Scenes of
    /// one moment, all of which throws and takes shadows. ShadowTimes::shadow_ms is that of the last frame.
    voxel,
    /// Rays from rasterized surfaces through an xy-reduced pyramid of voxels of one size, built for each
    /// moment (renderer/shadow/pyramid_shadows.h). All that is shown throws and takes shadows.
    pyramid,
    /// Atty et al. 2005 (renderer/shadow/map_shadows.h), for rectangular lights: some nodes throw shadows on
    /// others.
    soft_shadow_map,
};

/// What does not concern the method is not read.
struct ShadowOptions {
    TreeOptions tree = {};          ///< of voxel
    RendererOptions renderer = {};  ///< of voxel
    PyramidShadowOptions pyramid = {};
    SoftShadowOptions map = {};
};

/// @throws Error  Fault::usage for options out of range, and for casters, receivers or a motion that the
///                method cannot have, with a way out; Fault::memory when it does not fit.
[[nodiscard]] std::unique_ptr<ShadowRenderer> make_shadow_renderer(ShadowMethod method,
                                                                   const ShadowScene& scene,
                                                                   const ShadowOptions& options = {},
                                                                   const gl::ShaderSource& shaders = {});

}  // namespace cairn::renderer

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "gl/shader_source.h"
#include "renderer/shadow/shadow_base.h"
#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/shadow_mesh.h"
#include "shaders/interop/shadow_map.h"

namespace cairn::renderer {

/// Times, on the driver's clock, and counters of one SoftShadowMap::compute().
struct SoftShadowStatistics {
    /// All passes.
    double milliseconds = 0.0;
    /// Part of `milliseconds`: occluder map, receiver map, and the receiver map's pyramid.
    double maps_ms = 0.0;
    /// Part of `milliseconds`: listing the micro-patches.
    double patches_ms = 0.0;
    /// Part of `milliseconds`: drawing the penumbra extents of the micro-patches.
    double hide_ms = 0.0;
    /// Micro-patches of both passes together.
    std::uint64_t micro_patches = 0;
    /// Fragments of the penumbra extents: texels that a micro-patch was tried on.
    std::uint64_t fragments = 0;
    /// Sums that were started.
    std::uint64_t batches = 0;
};

/// A square map, row 0 at the low y of its window.
struct ShadowMapValues {
    int size = 0;
    std::vector<float> values;
    [[nodiscard]] float at(int x, int y) const {
        return values[std::size_t(y) * std::size_t(size) + std::size_t(x)];
    }
};

/// A texture, as seen from a rectangular light, of the share of the light that the receivers see past the
/// occluders. Needs the context that was current at its construction.
///
/// Based on: Atty, Holzschuch, Lapierre, Hasenfratz, Hansen, Sillion, "Soft Shadow Maps: Efficient Sampling
/// of Light Source Visibility", 2005. Sections 3.1 to 3.5 and appendix A, on the GPU throughout.
///
/// Limits of the method:
/// - Neither occluders nor receivers shadow their own kind.
/// - An occluder (receiver) behind another one, as seen from the light's centre, is ignored.
/// - Occluders nearer to the light's plane than the frustum's near distance, or outside its window, hide
///   nothing.
/// - A sheet that the light's centre sees edge-on hides nothing. Neither does an occluder in the receiver's
///   own place.
/// - Places without a receiver (behind the light, beyond the window) count as lit.
/// - The edge of a shadow is exact to half a texel of the occluder map; a light smaller than that does not
///   blur it.
/// - Where neighbouring texels differ much in depth, as along walls or close to the light, their patches hide
///   too much or too little (equation 3): 1 to 6 percent of the light on average over a shadow, more with a
///   larger light, and up to 10 percent in one pass or where the occluder touches the light.
/// - FP16 loses ever more from 128 texels on.
///
/// For several lights, make one map per light, and add the shares.
class SoftShadowMap {
public:
    /// @throws Error  Fault::usage if a size is out of range; Fault::context if the driver cannot blend the
    ///                format (OpenGL 4.5 requires it of every driver).
    explicit SoftShadowMap(const SoftShadowOptions& options = {}, const gl::ShaderSource& shaders = {});
    SoftShadowMap(SoftShadowMap&&) noexcept;
    SoftShadowMap& operator=(SoftShadowMap&&) noexcept;
    SoftShadowMap(const SoftShadowMap&) = delete;
    SoftShadowMap& operator=(const SoftShadowMap&) = delete;
    ~SoftShadowMap();

    /// Computes the map.
    /// @throws Error  Fault::usage if the light is not a rectangle, or if the frustum has a window without an
    ///                extent or a near distance that is not positive.
    void compute(const optics::Light& light, const ShadowFrustum& frustum, const ShadowMesh& occluders,
                 const ShadowMesh& receivers);

    [[nodiscard]] const SoftShadowOptions& options() const;
    // What follows is of the last compute().
    [[nodiscard]] const optics::Light& light() const;
    [[nodiscard]] const ShadowFrustum& frustum() const;
    [[nodiscard]] const SoftShadowStatistics& statistics() const;
    /// R32F, receiver_size texels per side: the share of the light that is seen, in [0, 1].
    [[nodiscard]] GLuint visible_texture() const;
    /// R32F, receiver_size texels per side: inverse depths of receivers; 0: no receiver.
    [[nodiscard]] GLuint receiver_texture() const;
    [[nodiscard]] ShadowMapValues visible() const;
    [[nodiscard]] ShadowMapValues receiver_inverse_depths() const;
    /// Inverse depths of occluders. A texel without an occluder is 0 in pass 0, and SHADOW_NONE in pass 1.
    /// @param pass  0: the closest occluders; 1: the furthest.
    [[nodiscard]] ShadowMapValues occluder_inverse_depths(int pass) const;
    /// Micro-patches of a pass, in the order of the texels.
    [[nodiscard]] std::vector<interop::MicroPatch> micro_patches(int pass) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer

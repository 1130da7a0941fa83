#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "gl/shader_source.h"
#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/shadow_mesh.h"
#include "renderer/shadow/shadow_options.h"
#include "shaders/interop/shadow_map.h"

namespace cairn::renderer {

struct SoftShadowStatistics {
    double milliseconds = 0.0;        ///< all passes, on the driver's clock
    double maps_ms = 0.0;             ///< of it: occluder map, receiver map and its pyramid
    double patches_ms = 0.0;          ///< of it: listing the micro-patches
    double hide_ms = 0.0;             ///< of it: drawing their penumbra extents
    std::uint64_t micro_patches = 0;  ///< of both passes
    std::uint64_t fragments = 0;      ///< of the penumbra extents: texels that a micro-patch was tried on
    std::uint64_t batches = 0;        ///< sums that were started
};

/// A square map, row 0 at the low y of its window.
struct ShadowMapValues {
    int size = 0;
    std::vector<float> values;
    [[nodiscard]] float at(int x, int y) const {
        return values[std::size_t(y) * std::size_t(size) + std::size_t(x)];
    }
};

/// What of a rectangular light the receivers see past the occluders, in a texture as seen from the light.
/// Needs the context that was current at its construction.
///
/// Based on: Atty, Holzschuch, Lapierre, Hasenfratz, Hansen, Sillion, "Soft Shadow Maps: Efficient Sampling
/// of Light Source Visibility", 2005. Sections 3.1 to 3.5 and appendix A, on the GPU throughout.
///
/// Limits of the method: neither occluders nor receivers shadow their own kind; of what stands behind another
/// occluder (receiver) as seen from the light's centre, nothing is known; occluders nearer to the light's
/// plane than the frustum's near distance, or outside its window, hide nothing; a sheet that the light's
/// centre sees edge-on hides nothing, nor does what lies in the receiver's own place. What has no receiver
/// (behind the light, beyond the window) counts as lit. The edge of a shadow is known to half a texel of the
/// occluder map, which a light smaller than that does not blur. Where neighbouring texels differ much in
/// depth, as along walls or close to the light, their patches hide too much or too little (equation 3): of
/// the light 1 to 6 percent on average over a shadow, the more the larger the light, and up to 10 in one pass
/// or where the occluder touches the light. FP16 loses ever more from 128 texels on. More lights than one are
/// as many maps: what is seen adds up.
class SoftShadowMap {
public:
    /// @throws Error  Fault::usage for a size out of range; Fault::context when the driver cannot blend the
    ///                format (OpenGL 4.5 asks every driver for it).
    explicit SoftShadowMap(const SoftShadowOptions& options = {}, const gl::ShaderSource& shaders = {});
    SoftShadowMap(SoftShadowMap&&) noexcept;
    SoftShadowMap& operator=(SoftShadowMap&&) noexcept;
    SoftShadowMap(const SoftShadowMap&) = delete;
    SoftShadowMap& operator=(const SoftShadowMap&) = delete;
    ~SoftShadowMap();

    /// @throws Error  Fault::usage for a light or a frustum that is none.
    void compute(const optics::Light& light, const ShadowFrustum& frustum, const ShadowMesh& occluders,
                 const ShadowMesh& receivers);

    // Of the last compute().
    [[nodiscard]] const SoftShadowOptions& options() const;
    [[nodiscard]] const optics::Light& light() const;
    [[nodiscard]] const ShadowFrustum& frustum() const;
    [[nodiscard]] const SoftShadowStatistics& statistics() const;
    /// R32F, receiver_size texels a side: the share of the light that is seen, in [0, 1].
    [[nodiscard]] GLuint visible_texture() const;
    /// R32F, the same size: inverse depths of receivers, 0 = none.
    [[nodiscard]] GLuint receiver_texture() const;
    [[nodiscard]] ShadowMapValues visible() const;
    [[nodiscard]] ShadowMapValues receiver_inverse_depths() const;
    /// @param pass  0: the closest occluders, 0 = none; 1: the furthest, SHADOW_NONE = none.
    [[nodiscard]] ShadowMapValues occluder_inverse_depths(int pass) const;
    /// Micro-patches of a pass, in the order of the texels.
    [[nodiscard]] std::vector<interop::MicroPatch> micro_patches(int pass) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer

#pragma once

#include <cstdint>

#include "renderer/shadow/column_mask.h"

namespace cairn::renderer {

/// Of renderer/shadow/pyramid_shadows.h.
struct PyramidShadowOptions {
    int resolution = 512;  ///< voxels across the scene: a power of two, 8 to 2048
    ColumnMask mask = ColumnMask::adaptive;
};

/// Which faces of the occluders become micro-patches (Atty et al. 2005, section 3.5).
enum class ShadowPasses : std::uint8_t {
    one,  ///< the closest to the light
    two,  ///< the furthest too, in a map of their own; of both maps, the one that hides more light counts
};

/// What the shares of the light that micro-patches hide are summed in (Atty et al. 2005, appendix A).
enum class ShadowFormat : std::uint8_t {
    fp16,          ///< loses what is less than 2^-11 of the sum
    fp16_batches,  ///< as many batches as the square root of the micro-patches, each summed alone
    fp32,
};

/// The most texels per side of a map of SoftShadowOptions.
constexpr int max_shadow_map_size = 2048;

/// Of renderer/shadow/soft_shadow_map.h.
struct SoftShadowOptions {
    /// Texels per side of the occluder map, [1, max_shadow_map_size]; Atty et al. find 128 enough mostly.
    int occluder_size = 128;
    /// Texels per side of the receiver map and of the soft shadow map, [1, max_shadow_map_size].
    int receiver_size = 256;
    ShadowPasses passes = ShadowPasses::two;
    ShadowFormat format = ShadowFormat::fp32;
    bool operator==(const SoftShadowOptions&) const = default;
};

}  // namespace cairn::renderer

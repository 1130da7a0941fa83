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

/// Of renderer/shadow/soft_shadow_map.h.
struct SoftShadowOptions {
    int occluder_size = 128;  ///< texels a side of the occluder map, [1, 2048]; Atty et al.: mostly enough
    int receiver_size = 256;  ///< of the receiver map and of the soft shadow map, [1, 2048]
    ShadowPasses passes = ShadowPasses::two;
    ShadowFormat format = ShadowFormat::fp32;
    bool operator==(const SoftShadowOptions&) const = default;
};

}  // namespace cairn::renderer

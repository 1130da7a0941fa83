#pragma once

#include <cstddef>

namespace cairn::gl {

/// What the current driver can hold.
struct Limits {
    std::size_t shader_storage_bytes = 0;  ///< size of one shader storage block
    std::size_t texture_buffer_texels = 0;
    int texture_3d_size = 0;  ///< texels along each side
    float anisotropy = 1.0F;  ///< the most that a sampler can; 1: the driver has none
};

[[nodiscard]] Limits query_limits();

}  // namespace cairn::gl

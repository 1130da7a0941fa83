#pragma once

#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/buffer.h"

namespace cairn::voxelizer {

/// Uploads values to a buffer that a shader can see whole.
/// @param limit_bytes  the most that a shader sees (gl::Limits)
/// @throws Error  Fault::memory if the values pass the limit.
template <typename T>
gl::Buffer upload_array(const std::vector<T>& values, const std::string& name, std::size_t limit_bytes) {
    const std::size_t bytes = values.size() * sizeof(T);
    if (bytes > limit_bytes) {
        throw Error(Fault::memory, name,
                    fmt::format("{:.1f} MiB are more than a shader of this driver can see ({:.1f} MiB)",
                                double(bytes) / 0x1p20, double(limit_bytes) / 0x1p20),
                    "use smaller images, or another driver");
    }
    return gl::Buffer::of(std::span<const T>(values), name);
}

}  // namespace cairn::voxelizer

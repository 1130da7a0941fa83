#pragma once

#include <cstddef>

namespace cairn::gl {

/// An offset in the buffer that is bound, as OpenGL wants it: as a pointer, from the days when arrays lay in
/// main memory.
/// @param bytes  from the buffer's start.
[[nodiscard]] inline void* buffer_offset(std::size_t bytes) {
    return reinterpret_cast<void*>(bytes);  // NOLINT(performance-no-int-to-ptr): it is never dereferenced
}

}  // namespace cairn::gl

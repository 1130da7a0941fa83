#pragma once

#include <cstddef>

namespace cairn::gl {

/// An offset in the bound buffer, as the pointer that OpenGL's functions take for it: the same argument was
/// the address of an array in main memory before there were buffers.
/// @param bytes  offset from the buffer's start.
[[nodiscard]] inline void* buffer_offset(std::size_t bytes) {
    return reinterpret_cast<void*>(bytes);  // NOLINT(performance-no-int-to-ptr): it is never dereferenced
}

}  // namespace cairn::gl

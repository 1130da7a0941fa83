#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gl/handle.h"

namespace cairn::gl {

/// A buffer of fixed size in the driver's memory (glNamedBufferStorage), which the CPU may read and write by
/// copies.
class Buffer {
public:
    Buffer() = default;

    /// @param name  what the buffer holds, for the text of an error.
    /// @throws Error  Fault::memory if the driver refuses the size. A driver may accept a buffer that is
    ///                larger than what a shader can see of it: compare the size with
    ///                `Limits::shader_storage_bytes` first.
    Buffer(std::size_t size_bytes, const std::string& name);

    /// A buffer that holds a copy of `data`; at least 16 bytes long, so that it can always be bound.
    template <typename T>
    static Buffer of(std::span<const T> data, const std::string& name) {
        Buffer buffer(std::max<std::size_t>(data.size_bytes(), 16), name);
        buffer.write(0, data.data(), data.size_bytes());
        return buffer;
    }

    void write(std::size_t offset_bytes, const void* data, std::size_t size_bytes);
    void read(std::size_t offset_bytes, void* data, std::size_t size_bytes) const;
    /// Fills the whole buffer.
    void fill(std::uint32_t word);
    void fill(std::size_t offset_bytes, std::size_t size_bytes, std::uint32_t word);

    template <typename T>
    [[nodiscard]] std::vector<T> read_all(std::size_t count, std::size_t offset_bytes = 0) const {
        std::vector<T> values(count);
        read(offset_bytes, values.data(), count * sizeof(T));
        return values;
    }

    void bind_storage(std::uint32_t binding) const;
    void bind_uniform(std::uint32_t binding) const;

    [[nodiscard]] std::uint32_t id() const { return handle_.id(); }
    [[nodiscard]] std::size_t size_bytes() const { return size_bytes_; }

private:
    BufferHandle handle_;
    std::size_t size_bytes_ = 0;
};

}  // namespace cairn::gl

#include "scenes/gltf/limits.h"

#include <fmt/format.h>

#include "scenes/gltf/failure.h"

namespace cairn::scenes::gltf {

void Budget::grant(std::uint64_t input_bytes) {
    left_ += input_bytes * bytes_per_input_byte;
}

void Budget::charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes) {
    if (each_bytes != 0 && count > left_ / each_bytes)
        fail(where,
             fmt::format("asks for {} times {} bytes, more than a file of this size can mean", count,
                         each_bytes),
             "the file is damaged or hostile; if it is genuine, split it");
    left_ -= count * each_bytes;
}

}  // namespace cairn::scenes::gltf

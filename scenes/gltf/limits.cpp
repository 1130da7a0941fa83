#include "scenes/gltf/limits.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "scenes/gltf/failure.h"

namespace cairn::scenes::gltf {

void fail_limit(const std::string& where, const std::string& what, std::uint64_t Limits::*limit,
                std::uint64_t needed) {
    const auto names = limit_names();
    const auto found = std::ranges::find(names, limit, &LimitName::value);
    fail(where, fmt::format("{}, which passes the limit \"{}\"", what, found->name),
         fmt::format("if the file is genuine, allow it by LoadOptions::limits {}={}", found->name, needed));
}

void Budget::grant(std::uint64_t input_bytes) {
    input_bytes_ += input_bytes;
    left_ += std::min(input_bytes * bytes_per_input_byte, unlimited - left_);
}

void Budget::charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes) {
    if (each_bytes != 0 && count > left_ / each_bytes)
        fail(where,
             fmt::format("asks for {} times {} bytes, more than a file of this size can mean", count,
                         each_bytes),
             "the file is damaged or hostile; if it is genuine, allow it by LoadOptions::memory_bytes");
    memory_.charge(where, what_, count, each_bytes);
    left_ -= count * each_bytes;
}

}  // namespace cairn::scenes::gltf

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scenes/load.h"

namespace cairn::scenes::gltf {

/// The two parts of a .glb (glTF 2.0, 4.4), or a .gltf, which has no binary part.
struct Container {
    std::string_view json;
    std::span<const std::uint8_t> binary;
    bool is_glb = false;
};

/// Splits the bytes of a file. Its first four bytes, not its name, decide whether it is a .glb.
/// @throws Error  if header or chunk lengths contradict the file's length, or the JSON passes a limit.
[[nodiscard]] Container split_container(const std::string& name, std::span<const std::uint8_t> file,
                                        const Limits& limits);

/// Refuses JSON that would take too much stack or memory to parse, before anything parses it.
/// @throws Error  if the JSON nests too deep, or holds too many values.
void check_json_size(const std::string& name, std::string_view json, const Limits& limits);

}  // namespace cairn::scenes::gltf

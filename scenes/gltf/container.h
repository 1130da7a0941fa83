#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace cairn::scenes::gltf {

/// The two parts of a .glb (glTF 2.0, 4.4), or a .gltf, which has no binary part.
struct Container {
    std::string_view json;
    std::span<const std::uint8_t> binary;
    bool is_glb = false;
};

/// Splits the bytes of a file; decides by its first four bytes, not by its name.
/// @throws Error  header or chunk lengths contradict the file's.
[[nodiscard]] Container split_container(const std::string& name, std::span<const std::uint8_t> file);

/// Refuses JSON that would take too much stack or memory to parse, before anything parses it.
/// @throws Error  it nests too deep, or holds too many values.
void check_json_size(const std::string& name, std::string_view json);

}  // namespace cairn::scenes::gltf

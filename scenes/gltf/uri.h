#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/load.h"

namespace cairn::scenes::gltf {

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a "data:" URI, base64 or percent-encoded (RFC 2397).
/// @throws Error  if the encoding is broken.
[[nodiscard]] std::vector<std::uint8_t> decode_data_uri(const std::string& where, std::string_view uri);

/// The file that a relative URI names. A backslash divides folders, as exporters on Windows write it.
///
/// @param folder       the folder of the .gltf file.
/// @param trust_paths  allows absolute paths and paths that leave the folder, but no other schemes.
/// @throws Error       if the URI has a scheme, is absolute or leaves the folder.
[[nodiscard]] std::filesystem::path resolve_uri(const std::string& where, std::string_view uri,
                                                const std::filesystem::path& folder, bool trust_paths);

/// The bytes of a regular file.
/// @param folder  the folder that it must lie in, once links are followed; empty: any.
/// @throws Error  if it is missing, is no regular file, is larger than Limits::file_bytes, or lies elsewhere.
[[nodiscard]] std::vector<std::uint8_t> read_file(const std::string& where, const std::filesystem::path& path,
                                                  const Limits& limits,
                                                  const std::filesystem::path& folder = {});

/// The bytes that a URI stands for: its own, if it is a "data:" URI, or those of a file beside the glTF file.
/// @throws Error  as the functions above.
[[nodiscard]] std::vector<std::uint8_t> read_uri(const std::string& where, std::string_view uri,
                                                 const std::filesystem::path& folder,
                                                 const LoadOptions& options);

}  // namespace cairn::scenes::gltf

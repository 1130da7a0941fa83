#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace cairn::scenes::gltf {

/// "buffers" of the file. Their bytes are read when something needs them (buffers.h).
struct BufferSource {
    std::optional<std::string> uri;
    std::uint64_t byte_length = 0;
};

/// "images" of the file. Only those that a base colour uses are read (images.h).
struct ImageSource {
    std::string name;
    std::optional<std::string> uri;
    int buffer_view = -1;  ///< checked
};

/// A glTF file, parsed and checked against schema.h, not yet converted.
struct Source {
    std::string name;  ///< the file's name without its folder, for messages
    std::filesystem::path folder;
    bool trust_paths = false;
    std::vector<std::uint8_t> file;           ///< the whole .glb; empty for .gltf
    std::span<const std::uint8_t> glb_chunk;  ///< the binary chunk of the .glb, inside `file`
    std::uint64_t json_bytes = 0;
    std::vector<BufferSource> buffers;
    std::vector<ImageSource> images;
    /// Everything but buffers and images. An index accessor without a buffer view has `no_view` (tinygltf
    /// refuses -1).
    tinygltf::Model model;
    int no_view = -1;  ///< one past the file's last buffer view

    /// For messages: "ear.glb: accessor 7".
    [[nodiscard]] std::string where(const std::string& element_text) const {
        return name + ": " + element_text;
    }
};

/// Reads and checks a file. tinygltf gets to see only JSON that has passed the checks, and opens nothing.
/// @throws Error
[[nodiscard]] Source read_source(const std::filesystem::path& path, bool trust_paths);

}  // namespace cairn::scenes::gltf

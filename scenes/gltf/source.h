#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "scenes/load.h"

namespace cairn::scenes::gltf {

/// One of the file's "buffers". Its bytes are read when something needs them (buffers.h).
struct BufferSource {
    std::optional<std::string> uri;
    std::uint64_t byte_length = 0;
};

/// One of the file's "images". It is read only if a base colour uses it (images.h).
struct ImageSource {
    std::string name;
    std::optional<std::string> uri;
    int buffer_view = -1;  ///< in range, checked; -1: the image has a URI
};

/// A glTF file, parsed and checked against schema.h, not yet converted.
struct Source {
    std::string name;  ///< the file's name without its folder, for messages
    std::filesystem::path folder;
    LoadOptions options;
    std::vector<std::uint8_t> file;           ///< the whole .glb; empty for .gltf
    std::span<const std::uint8_t> glb_chunk;  ///< the binary chunk of the .glb, inside `file`
    std::uint64_t json_bytes = 0;
    std::vector<BufferSource> buffers;
    std::vector<ImageSource> images;
    /// The parsed file, but for buffers and images. An index accessor without a buffer view has `no_view`
    /// (tinygltf refuses -1).
    tinygltf::Model model;
    int no_view = -1;  ///< one past the file's last buffer view

    /// The place of an element, for messages: "ear.glb: accessor 7".
    [[nodiscard]] std::string where(const std::string& element_text) const {
        return name + ": " + element_text;
    }
};

/// Reads and checks a file. tinygltf parses only JSON that has passed the checks, and opens no file.
/// @throws Error  (Fault::input) if the file cannot be read or does not pass.
[[nodiscard]] Source read_source(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace cairn::scenes::gltf

#pragma once

#include <span>
#include <string_view>

namespace cairn::shaders {

/// One file of the folder shaders/ as it was when the library was built; the name is relative to that folder
/// ("march/march.glsl").
struct EmbeddedFile {
    std::string_view name;
    std::string_view text;
};

[[nodiscard]] std::span<const EmbeddedFile> embedded_files();

}  // namespace cairn::shaders

#pragma once

#include <filesystem>

#include "renderer/renderer.h"

namespace cairn::app {

/// Writes an 8-bit sRGB PNG without alpha: the background is blended in already.
/// @throws Error if the file cannot be written.
void write_png(const optics::Image& image, const std::filesystem::path& path);

}  // namespace cairn::app

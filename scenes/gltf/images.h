#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scenes/gltf/limits.h"
#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// Decodes a PNG or JPEG to 8-bit RGBA.
///
/// The size that the file claims is checked before anything is allocated, and a stream that unpacks to more
/// than that size needs is refused.
/// @param budget  of all pictures; grows by this file.
/// @throws Error  the image is damaged, of another format, or too large.
[[nodiscard]] Image decode_image(const std::string& where, std::span<const std::uint8_t> file,
                                 Budget& budget);

}  // namespace cairn::scenes::gltf

#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// Decodes a PNG or JPEG to 8-bit RGBA.
///
/// The size that the file claims is checked before anything is allocated, and a stream that unpacks to more
/// than that size needs is refused.
/// @param left_bytes  what all images together may still take.
/// @throws Error      the image is damaged, of another format, or too large.
[[nodiscard]] Image decode_image(const std::string& where, std::span<const std::uint8_t> file,
                                 std::uint64_t left_bytes);

}  // namespace cairn::scenes::gltf

#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scenes/gltf/limits.h"
#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// Decodes a PNG or JPEG to 8-bit RGBA.
///
/// The size that the file claims is checked before anything is allocated. A stream that unpacks to more bytes
/// than that size needs is refused.
/// @param budget  the budget of all pictures, which grows by the bytes of this file.
/// @param most_bytes  limit of the unpacked picture (Limits::image_bytes).
/// @throws Error  if the image is damaged, of another format, or too large.
[[nodiscard]] Image decode_image(const std::string& where, std::span<const std::uint8_t> file, Budget& budget,
                                 std::uint64_t most_bytes);

}  // namespace cairn::scenes::gltf

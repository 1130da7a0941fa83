#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

/// Mip levels of textures whose colours are means in linear light.
namespace cairn::voxelizer {

/// Size of the next coarser level: half, rounded down, and at least 1.
[[nodiscard]] inline glm::ivec2 coarser_mip_size(const glm::ivec2& size) {
    return {size.x > 1 ? size.x / 2 : 1, size.y > 1 ? size.y / 2 : 1};
}

/// Texels of all levels from level 1 on, to the one of 1 x 1; 0 for a texture of 1 x 1.
[[nodiscard]] std::size_t mip_texels(const glm::ivec2& size);

/// The levels from level 1 on, one behind the other, row after row.
///
/// A texel's colour is the mean over the texels of level 0 under it that are kept, in linear light, encoded
/// in sRGB like the image. If the size of a level is odd, the texels of the next one cover whole texels and
/// parts of texels. Its alpha is the share that is kept: 0 only if nothing is, 255 only if everything is.
///
/// @param texels        RGBA8 in a word, red in the low bits; size.x * size.y of them.
/// @param lowest_alpha  texels with a lower alpha (0 to 255) are left out; 0 keeps all.
[[nodiscard]] std::vector<std::uint32_t> mips_of(std::span<const std::uint32_t> texels,
                                                 const glm::ivec2& size, std::uint32_t lowest_alpha);

/// All levels, from level 0 on, for samplers that know nothing of masks: the texels that are left out have
/// the colours of kept texels around them, taken from the finest level that has any there. Alphas of level 0
/// are the image's.
[[nodiscard]] std::vector<std::uint32_t> filled_levels(std::span<const std::uint32_t> texels,
                                                       const glm::ivec2& size, std::uint32_t lowest_alpha);

}  // namespace cairn::voxelizer

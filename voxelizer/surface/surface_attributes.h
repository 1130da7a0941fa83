#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "shaders/interop/surface.h"

namespace cairn::voxelizer {

/// @param normal  as SurfaceAttributes::normal
/// @param color   linear RGBA, 65535 = 1
[[nodiscard]] inline interop::SurfaceAttributes surface_attributes(std::uint32_t normal,
                                                                   const glm::u16vec4& color,
                                                                   const glm::vec2& texcoord) {
    return {normal, color.r | std::uint32_t(color.g) << 16, color.b | std::uint32_t(color.a) << 16,
            texcoord.x, texcoord.y};
}

/// The alpha of a vertex, 65535 = 1.
[[nodiscard]] inline std::uint16_t alpha_of(const interop::SurfaceAttributes& attributes) {
    return std::uint16_t(attributes.blue_alpha >> 16);
}

[[nodiscard]] inline glm::vec2 texcoord_of(const interop::SurfaceAttributes& attributes) {
    return {attributes.u, attributes.v};
}

}  // namespace cairn::voxelizer

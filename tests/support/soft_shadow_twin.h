#pragma once

#include <array>
#include <vector>

#include "renderer/shadow/soft_shadow_map.h"
#include "scenes/snapshot.h"
#include "shaders/interop/shadow_map.h"

/// The twin of the soft shadow map: on the CPU, in double, without penumbra extents. Every micro-patch is
/// tried on every receiver.
namespace cairn::test {

/// Triangles in light space.
using LightTriangles = std::vector<std::array<glm::dvec3, 3>>;
[[nodiscard]] LightTriangles in_light_space(const scenes::Snapshot& snapshot, const optics::Light& light);

/// Inverse depths along the ray from the light's centre, past the near distance; 0 if the ray meets nothing.
struct DepthRange {
    double closest = 0.0;   ///< greatest inverse depth
    double furthest = 0.0;  ///< least inverse depth
};
[[nodiscard]] DepthRange cast(const LightTriangles& triangles, const glm::dvec2& tangents,
                              double near_distance);

/// The share of the light that one micro-patch hides from one receiver: Atty et al. 2005, section 3.4, with
/// lengths instead of the shader's tangents.
[[nodiscard]] double hidden_by(const renderer::SoftShadowMap& map, const interop::MicroPatch& patch, int x,
                               int y, double receiver_inverse_depth);

/// The values of the whole map, row by row, from the two depth maps of `map`.
[[nodiscard]] std::vector<double> twin_of(const renderer::SoftShadowMap& map);

}  // namespace cairn::test

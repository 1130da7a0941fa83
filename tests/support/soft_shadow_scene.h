#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/soft_shadow_map.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

/// Occluders over a floor, under a light that looks straight down: light space is (x, z, height - y).
namespace cairn::test {

using Corners = std::vector<glm::dvec3>;  ///< corners of triangles, three each

/// A quad as two triangles: a, b, c and a, c, d.
[[nodiscard]] Corners quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                           const glm::dvec3& d);
/// A horizontal square, turned by `angle` around the vertical.
[[nodiscard]] Corners square(const glm::dvec3& centre, double half, double angle = 0.0);
[[nodiscard]] Corners box(const glm::dvec3& low, const glm::dvec3& high);
/// A sphere of 20 * 4^depth triangles.
[[nodiscard]] Corners ball(const glm::dvec3& centre, double radius, int depth);

/// Node 0 "floor" holds the receivers, node 1 "thing" the occluders.
struct ShadowScene {
    ShadowScene(const Corners& occluders, const Corners& receivers);
    scenes::Scene scene;
    scenes::Snapshot whole, occluders, receivers;
};

/// A light that shines down from `height` on x = z = 0.
[[nodiscard]] optics::Light light_above(double height, double half_x, double half_z);

/// Computes the map with fitted windows, or with the given ones. Needs a context.
[[nodiscard]] renderer::SoftShadowMap shadow_of(const ShadowScene& scene, const optics::Light& light,
                                                const renderer::SoftShadowOptions& options);
[[nodiscard]] renderer::SoftShadowMap shadow_of(const ShadowScene& scene, const optics::Light& light,
                                                const renderer::SoftShadowOptions& options,
                                                const renderer::ShadowFrustum& frustum);

/// The point of a receiver that a texel of the soft shadow map stands for.
struct ReceiverPoint {
    int x = 0;
    int y = 0;
    glm::dvec3 position{0.0};  ///< position in light space
    double visible = 1.0;      ///< visible share of the light by the map
};
/// The points of all texels that have a receiver.
[[nodiscard]] std::vector<ReceiverPoint> receiver_points(const renderer::SoftShadowMap& map);

/// The error by Atty et al. 2005, section 4.2.1, given a truth per point: the mean of absolute differences
/// over all points that are in shadow or penumbra by the map or in truth.
struct ShadowError {
    double mean = 0.0;
    double greatest = 0.0;
    std::size_t shadowed = 0;
    std::string worst;
};
[[nodiscard]] ShadowError error_of(const std::vector<ReceiverPoint>& points,
                                   const std::vector<double>& truth);

/// The share of the light that is seen past a flat convex polygon parallel to it: exact, by clipping the
/// polygon's projection. Everything is in light space; the polygon's points are in order, at depth `depth`.
[[nodiscard]] double visible_past(const std::vector<glm::dvec2>& polygon, double depth,
                                  const glm::dvec3& point, const glm::dvec2& light_half);

}  // namespace cairn::test

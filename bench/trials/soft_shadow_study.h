#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "optics/light.h"
#include "reference/image.h"
#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/shadow_mesh.h"
#include "renderer/shadow/soft_shadow_map.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

/// The experiments of Atty et al. 2005, section 4.2: an occluder over a level floor, under a square light
/// that looks straight down, and how far a soft shadow map is from what rays find. Lengths are in units of
/// the occluder's longest side.
namespace cairn::bench {

/// Triangles alone, an alpha mask counts as whole. The middle of their bounds is at x = z = 0 and their
/// lowest point at y = 0; their longest side is 1.
class ShadowOccluder {
public:
    /// @param path  what scenes::load takes; and builtin:square, 1 x 1, level and along the light's edges.
    /// @throws Error  as loading does; Fault::usage for a scene without triangles.
    explicit ShadowOccluder(const std::string& path);
    /// The same shape of parts^2 times as many triangles.
    [[nodiscard]] ShadowOccluder cut(int parts) const;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scenes::Scene& scene() const { return *scene_; }
    [[nodiscard]] const scenes::Snapshot& snapshot() const { return snapshot_; }
    [[nodiscard]] double height() const { return snapshot_.bounds.high.y; }
    /// How high its lowest point is over the floor where nothing else is said: the square floats, all else
    /// stands.
    [[nodiscard]] double own_gap() const { return height() > 0.0 ? 0.0 : 0.5; }

private:
    ShadowOccluder(std::string name, scenes::Scene scene);
    std::string name_;
    std::unique_ptr<scenes::Scene> scene_;  ///< the snapshot points into it
    scenes::Snapshot snapshot_;
};

/// How high the light is over the floor.
inline constexpr double study_light_height = 3.0;

struct ShadowPlacement {
    double light_width = 0.5;
    double lateral = 0.0;  ///< of the occluder, from under the light's middle along x
    double gap = 0.0;      ///< between the floor and the occluder's lowest point
};

enum class StudyWindow : std::uint8_t {
    fitted,  ///< the occluder map covers the occluders alone
    shared,  ///< it covers what the soft shadow map covers, too: the one frustum of Atty et al.
};

/// One placement, and what of the light is seen from the points of the floor. The occluder must outlive it.
/// Needs the context that was current at its construction.
class StudySetting {
public:
    StudySetting(const ShadowOccluder& occluder, const ShadowPlacement& placement);

    [[nodiscard]] const ShadowPlacement& placement() const { return placement_; }
    [[nodiscard]] const optics::Light& light() const { return light_; }
    [[nodiscard]] const renderer::ShadowMesh& floor() const { return *floor_mesh_; }
    /// The receivers' window is the same in both.
    [[nodiscard]] renderer::ShadowFrustum frustum(StudyWindow window) const;
    [[nodiscard]] double floor_height() const { return -placement_.gap; }

private:
    ShadowPlacement placement_;
    optics::Light light_;
    std::unique_ptr<scenes::Scene> floor_;
    scenes::Snapshot floor_snapshot_;
    std::unique_ptr<renderer::ShadowMesh> floor_mesh_;
    renderer::ShadowFrustum fitted_;
};

/// Points of receivers that the centres of texels of a soft shadow map stand for: the middle one of each
/// study_step x study_step texels. They depend on the receivers' window and the map's size, and not on the
/// occluder map; so one truth serves occluder maps of all sizes.
struct ShadowPoints {
    std::vector<glm::ivec2> texels;
    std::vector<glm::dvec3> world;
};
inline constexpr int study_step = 3;
[[nodiscard]] ShadowPoints shadow_points(const renderer::SoftShadowMap& map);

/// What of the light each point sees, by Embree, to a standard error of 1/512.
[[nodiscard]] std::vector<double> truth_at(const ShadowPoints& points, const reference::ImageTracer& occluder,
                                           const optics::Light& light);

/// Atty et al. 2005, section 4.2.1: over the points that are in shadow or penumbra, by the map or in truth.
struct SoftShadowErrors {
    double mean = 0.0;  ///< of absolute differences
    double rmse = 0.0;
    double greatest = 0.0;
    std::size_t shadowed = 0;
    std::size_t wrong = 0;  ///< of them, those that differ by more than 1/16
};
[[nodiscard]] SoftShadowErrors soft_shadow_errors(const renderer::ShadowMapValues& visible,
                                                  const ShadowPoints& points,
                                                  const std::vector<double>& truth);

}  // namespace cairn::bench

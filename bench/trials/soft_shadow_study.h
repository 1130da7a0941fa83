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
/// that looks straight down, and the error of a soft shadow map against rays. Lengths are in units of the
/// occluder's longest side.
namespace cairn::bench {

/// An occluder: the triangles of a scene, without alpha masks. The middle of its bounds is at x = z = 0, its
/// lowest point at y = 0, and its longest side is 1.
class ShadowOccluder {
public:
    /// @param path  as for scenes::load(); or builtin:square, 1 x 1, level and parallel to the light's edges.
    /// @throws Error  as loading does; Fault::usage if the scene has no triangles.
    explicit ShadowOccluder(const std::string& path);
    /// The same shape, of parts^2 times as many triangles.
    [[nodiscard]] ShadowOccluder cut(int parts) const;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scenes::Scene& scene() const { return *scene_; }
    [[nodiscard]] const scenes::Snapshot& snapshot() const { return snapshot_; }
    [[nodiscard]] double height() const { return snapshot_.bounds.high.y; }
    /// Default height of the lowest point over the floor: the square floats, everything else stands.
    [[nodiscard]] double default_gap() const { return height() > 0.0 ? 0.0 : 0.5; }

private:
    ShadowOccluder(std::string name, scenes::Scene scene);
    std::string name_;
    std::unique_ptr<scenes::Scene> scene_;  ///< the snapshot points into it
    scenes::Snapshot snapshot_;
};

/// Height of the light over the floor.
inline constexpr double study_light_height = 3.0;

struct ShadowPlacement {
    double light_width = 0.5;
    /// Offset along x of the occluder from the light's middle.
    double lateral = 0.0;
    /// Height of the occluder's lowest point over the floor.
    double gap = 0.0;
};

enum class StudyWindow : std::uint8_t {
    /// The occluder map covers the occluders alone.
    fitted,
    /// The occluder map covers the window of the soft shadow map, too: the one frustum of Atty et al.
    shared,
};

/// A placement of an occluder over the floor under the light. The occluder must outlive it. Needs the context
/// that was current at its construction.
class StudyCase {
public:
    StudyCase(const ShadowOccluder& occluder, const ShadowPlacement& placement);

    [[nodiscard]] const ShadowPlacement& placement() const { return placement_; }
    [[nodiscard]] const optics::Light& light() const { return light_; }
    [[nodiscard]] const renderer::ShadowMesh& floor() const { return *floor_mesh_; }
    /// The frustum of a soft shadow map. The receivers' window does not depend on `window`.
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

/// Points of receivers at the centres of texels of a soft shadow map: at the middle one of each study_step x
/// study_step texels. They depend on the receivers' window and on the map's size, but not on the occluder
/// map, so that one truth serves occluder maps of all sizes.
struct ShadowPoints {
    std::vector<glm::ivec2> texels;
    std::vector<glm::dvec3> world;
};
inline constexpr int study_step = 3;
[[nodiscard]] ShadowPoints shadow_points(const renderer::SoftShadowMap& map);

/// The share of the light that each point sees, by Embree, to a standard error of 1/512.
[[nodiscard]] std::vector<double> truth_at(const ShadowPoints& points, const reference::ImageTracer& occluder,
                                           const optics::Light& light);

/// Atty et al. 2005, section 4.2.1: over points in shadow or penumbra, by the map or in truth.
struct SoftShadowErrors {
    double mean = 0.0;         ///< mean of absolute differences
    double rmse = 0.0;         ///< root of the mean square difference
    double greatest = 0.0;     ///< greatest absolute difference
    std::size_t shadowed = 0;  ///< points in shadow or penumbra
    std::size_t wrong = 0;     ///< such points that differ by more than 1/16
};
[[nodiscard]] SoftShadowErrors soft_shadow_errors(const renderer::ShadowMapValues& visible,
                                                  const ShadowPoints& points,
                                                  const std::vector<double>& truth);

}  // namespace cairn::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "optics/camera.h"
#include "optics/light.h"
#include "reference/image.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {

struct AreaLightOptions {
    double standard_error = 1.0 / 512;  ///< sampling of a point stops below this
    int least_samples = 256;            ///< samples that every point takes
    int most_samples = 65536;           ///< sampling of a point stops at this count
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0 = all cores; the result does not depend on it
    /// If not 0, each point takes exactly the square of this many samples, one in each of as many strata:
    /// then the three limits above do not count, and the standard error is the most that so few samples can
    /// have.
    int exact_strata = 0;
    /// Packets are faster, and find the same.
    ImageTracer::Rays rays = ImageTracer::Rays::single;
};

struct LightVisibility {
    double visible = 1.0;         ///< share of the light that the point sees, in [0, 1]
    double standard_error = 0.0;  ///< standard error of `visible`, estimated from the samples
    int samples = 0;
};

/// The share of a light that each point sees past the tracer's triangles, by stratified samples: uniform in
/// the area of a rectangle or disk, and in the solid angle of a sphere. A directional light is replaced by a
/// sphere as wide as the light's angle, 1e5 diagonals of the tracer's scene from the scene's middle.
///
/// Samples come in rounds of 8 x 8 strata, one jittered sample each; the spread of the rounds' means gives
/// the standard error. An occluder that hides much less than 1 / least_samples of the light may be missed.
///
/// @param points   world.
/// @param normals  one per point: the point does not see what lies below its tangent plane. 0: the point
///                 has no normal; empty: no point has one.
/// @param light    must have an extent.
/// @throws Error  Fault::usage if the light has no extent, a point lies inside a sphere light, a sample count
///                or the standard error is not positive, or there are not as many normals as points.
[[nodiscard]] std::vector<LightVisibility> area_light_visibility(const ImageTracer& tracer,
                                                                 std::span<const glm::dvec3> points,
                                                                 std::span<const glm::dvec3> normals,
                                                                 const optics::Light& light,
                                                                 const AreaLightOptions& options = {});

/// A picture, and a light whose shadow on it is wanted. The whole snapshot is seen and throws shadows.
struct ShadowQuestion {
    const scenes::Scene& scene;
    const scenes::Snapshot& snapshot;
    const scenes::NodeSelection& receivers;  ///< nodes whose pixels count
    const optics::Camera& camera;
    const optics::Light& light;
    int width = 512;  ///< pixels
    int height = 512;
};

/// The pixels that can be shadowed: the ray through the pixel's centre meets a receiver first, and the side
/// of its triangle that the eye sees faces the light's middle.
struct ShadowReceivers {
    ReferenceImage seen;              ///< picture with the hard shadow of the light's middle
    std::vector<std::size_t> pixels;  ///< numbers of the pixels, row after row
    std::vector<glm::dvec3> points;   ///< world, one per pixel
    std::vector<glm::dvec3> normals;  ///< unit normals of the triangles, on the eye's side
};
/// @param tracer  holds the question's scene and snapshot.
[[nodiscard]] ShadowReceivers shadow_receivers(const ImageTracer& tracer, const ShadowQuestion& question);

/// The share of the light that arrives, per pixel of the picture: in [0, 1]; -1 for pixels that cannot be
/// shadowed.
/// @param values  one per pixel of `receivers`.
[[nodiscard]] std::vector<float> shares_of(const ShadowReceivers& receivers, std::span<const float> values);
/// The shares of a hard shadow: 0 or 1.
[[nodiscard]] std::vector<float> hard_shares(const ShadowReceivers& receivers);

struct SoftShares {
    std::vector<float> shares;
    double greatest_standard_error = 0.0;
    double milliseconds = 0.0;  ///< 0 if the answer comes from the cache
    bool cached = false;
};
/// The shares of a soft shadow.
/// @param cache  a folder that keeps answers by a hash of all that they depend on; created if need be.
/// @throws Error  as area_light_visibility() does; Fault::usage if the folder cannot be written.
[[nodiscard]] SoftShares soft_shares(const ImageTracer& tracer, const ShadowQuestion& question,
                                     const ShadowReceivers& receivers, const AreaLightOptions& options = {},
                                     const std::optional<std::filesystem::path>& cache = std::nullopt);

/// The error of a shadow, over the pixels for which both the shadow and the truth have a share.
struct ShadowError {
    std::size_t pixels = 0;
    /// Pixels where less than half of the light arrives in truth.
    std::size_t shadowed = 0;
    /// Pixels where half of the light or more arrives in the shadow, and less in truth.
    std::size_t too_light = 0;
    /// Pixels where less than half of the light arrives in the shadow, and half or more in truth.
    std::size_t too_dark = 0;
    /// Pixels in shadow or penumbra: not all of the light arrives in truth.
    std::size_t in_shadow = 0;
    double absolute_sum = 0.0;
    double square_sum = 0.0;
    double greatest = 0.0;

    [[nodiscard]] double disagreement() const;
    [[nodiscard]] double mean_absolute() const;
    [[nodiscard]] double rmse() const;
    /// Sum of all absolute differences, over the number of pixels in shadow or penumbra (Atty et al. 2005,
    /// section 4.2).
    [[nodiscard]] double mean_in_shadow() const;
};
/// @param shares  one per pixel, as `truth`; a pixel with a negative share in either is not compared, for two
///                rasterizers need not agree on what a pixel at an edge shows.
[[nodiscard]] ShadowError shadow_error(std::span<const float> shares, std::span<const float> truth);

}  // namespace cairn::reference

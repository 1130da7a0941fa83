#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "optics/light.h"
#include "reference/image.h"

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
/// @param normals  one per point: the point does not see what lies below its tangent plane. A normal of 0:
/// the
///                 point has none; empty: no point has one.
/// @param light    must have an extent.
/// @throws Error  Fault::usage if the light has no extent, a point lies inside a sphere light, a sample count
/// or
///                the standard error is not positive, or there are not as many normals as points.
[[nodiscard]] std::vector<LightVisibility> area_light_visibility(const ImageTracer& tracer,
                                                                 std::span<const glm::dvec3> points,
                                                                 std::span<const glm::dvec3> normals,
                                                                 const optics::Light& light,
                                                                 const AreaLightOptions& options = {});

}  // namespace cairn::reference

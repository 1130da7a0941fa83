#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "optics/camera.h"
#include "optics/light.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {

/// What a picture's rays hit. Values come row after row, pixel (0, 0) at the top left.
struct ReferenceImage {
    static constexpr std::uint32_t no_primitive = 0xFFFFFFFFU;

    int width = 0;
    int height = 0;
    /// Distance from the eye, world units; infinite if the pixel shows nothing.
    std::vector<float> depth;
    /// 1 if nothing stands between the surface and the light.
    std::vector<std::uint8_t> lit;
    /// Number of the triangle, counted through the snapshot's items; or no_primitive.
    std::vector<std::uint32_t> primitive;
    /// Time of all rays, without the construction of the bounding volume hierarchy.
    double milliseconds = 0.0;
};

/// How surfaces are shaded: base colour times the cosine to the light, and some light from everywhere, as in
/// the ray-marcher's pictures.
struct Shading {
    glm::vec3 light_color{1.0F};
    float ambient = 0.25F;                      ///< light from everywhere, as a share of light_color
    glm::vec3 background{0.80F, 0.84F, 0.90F};  ///< linear
    bool shadows = true;
};

/// A shaded picture. Values come row after row, from the top left.
struct ShadedImage {
    int width = 0;
    int height = 0;
    std::vector<glm::vec3> srgb;  ///< sRGB-encoded colours, [0, 1]
    std::vector<float> coverage;  ///< share of the pixel's samples that meet the scene
    double milliseconds = 0.0;
};

/// Traces rays through a snapshot's triangles with Embree (lines and points have no area and are left out):
/// one ray through the centre of each pixel, and one shadow ray from the point that it hits. Alpha masks let
/// rays through where the nearest texel fails the cutoff.
class ImageTracer {
public:
    /// Scene and snapshot must outlive the tracer. @throws Error  Fault::memory if Embree cannot hold the
    /// triangles.
    ImageTracer(const scenes::Scene& scene, const scenes::Snapshot& snapshot);
    ImageTracer(const ImageTracer&) = delete;
    ImageTracer& operator=(const ImageTracer&) = delete;
    ImageTracer(ImageTracer&&) = delete;
    ImageTracer& operator=(ImageTracer&&) = delete;
    ~ImageTracer();

    /// How rays are traced: one at a time, or in packets of 4 x 2 pixels, which find the same.
    enum class Rays : std::uint8_t { single, packets };

    /// @param light    shadow rays go to its middle.
    /// @param threads  0 = all cores.
    [[nodiscard]] ReferenceImage trace(const optics::Camera& camera, const optics::Light& light, int width,
                                       int height, int threads = 0, Rays kind = Rays::single) const;

    /// Shades the picture with samples_per_side^2 rays per pixel, on a regular grid, each with a shadow ray.
    [[nodiscard]] ShadedImage shade(const optics::Camera& camera, const optics::Light& light,
                                    const Shading& shading, int width, int height,
                                    int samples_per_side) const;

    /// Whether a surface stands between two points of the world. The surfaces that the points lie on do not
    /// count: whatever is nearer to `from` or `to` than 1e-5 of the scene's diagonal is not seen.
    [[nodiscard]] bool blocked(const glm::dvec3& from, const glm::dvec3& to) const;
    /// Number of points that are not blocked from `from`, as blocked() has it.
    [[nodiscard]] int count_reached(const glm::dvec3& from, std::span<const glm::dvec3> to, Rays kind) const;

    [[nodiscard]] double build_milliseconds() const;
    /// Centre of the snapshot's bounds, world; the world's origin if the bounds are empty.
    [[nodiscard]] const glm::dvec3& centre() const;
    /// Diagonal of the snapshot's bounds, world units; 1 if the bounds are empty.
    [[nodiscard]] double diagonal() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::reference

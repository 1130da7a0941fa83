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

/// Row after row, pixel (0, 0) at the top left.
struct ReferenceImage {
    static constexpr std::uint32_t no_primitive = 0xFFFFFFFFU;

    int width = 0;
    int height = 0;
    std::vector<float> depth;       ///< distance from the eye in the world; infinite = nothing there
    std::vector<std::uint8_t> lit;  ///< 1 = nothing stands between the surface and the light
    /// Number of the triangle, counted through the snapshot's items; or no_primitive.
    std::vector<std::uint32_t> primitive;
    /// Time of all rays; the tree of boxes is built before.
    double milliseconds = 0.0;
};

/// How surfaces look: base colour by the cosine to the light, and by some light from everywhere, as the
/// ray-marcher's pictures do.
struct Shading {
    glm::vec3 light_color{1.0F};
    float ambient = 0.25F;                      ///< light from everywhere, as a share of the light's own
    glm::vec3 background{0.80F, 0.84F, 0.90F};  ///< linear
    bool shadows = true;
};

/// Row after row, from the top left.
struct ShadedImage {
    int width = 0;
    int height = 0;
    std::vector<glm::vec3> srgb;  ///< encoded, [0, 1]
    std::vector<float> coverage;  ///< share of the pixel's samples that meet the scene
    double milliseconds = 0.0;
};

/// What Embree sees of a snapshot's triangles (lines and points have no area and are left out): one ray
/// through the centre of each pixel and one shadow ray from where it ends. Alpha masks let rays through where
/// the nearest texel fails the cutoff.
class ImageTracer {
public:
    /// Both must outlive the tracer. @throws Error  Fault::memory when Embree cannot hold the triangles.
    ImageTracer(const scenes::Scene& scene, const scenes::Snapshot& snapshot);
    ImageTracer(const ImageTracer&) = delete;
    ImageTracer& operator=(const ImageTracer&) = delete;
    ImageTracer(ImageTracer&&) = delete;
    ImageTracer& operator=(ImageTracer&&) = delete;
    ~ImageTracer();

    /// One at a time, or in packets of 4 x 2 pixels, which find the same.
    enum class Rays : std::uint8_t { single, packets };

    /// @param light    its middle.
    /// @param threads  0 = all cores.
    [[nodiscard]] ReferenceImage trace(const optics::Camera& camera, const optics::Light& light, int width,
                                       int height, int threads = 0, Rays kind = Rays::single) const;

    /// The picture with samples_per_side^2 rays per pixel, on a regular grid, each with a shadow ray.
    [[nodiscard]] ShadedImage shade(const optics::Camera& camera, const optics::Light& light,
                                    const Shading& shading, int width, int height,
                                    int samples_per_side) const;

    /// Whether a surface stands between two points of the world. Either end's own surface does not count:
    /// what is nearer to `from` or `to` than 1e-5 of the scene's diagonal is not seen.
    [[nodiscard]] bool blocked(const glm::dvec3& from, const glm::dvec3& to) const;
    /// To how many points no surface stands in the way, in the same sense.
    [[nodiscard]] int count_reached(const glm::dvec3& from, std::span<const glm::dvec3> to, Rays kind) const;

    [[nodiscard]] double build_milliseconds() const;
    /// Of the snapshot's bounds, world: the origin of a scene without any.
    [[nodiscard]] const glm::dvec3& centre() const;
    /// The same bounds' diagonal: 1 of a scene without any.
    [[nodiscard]] double diagonal() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::reference

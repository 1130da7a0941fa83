#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "reference/embree.h"
#include "reference/image.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {

/// A point on a triangle, by the weights of its corners.
struct TrianglePoint {
    unsigned triangle = 0;  ///< its number in the primitive
    glm::vec3 weights{1.0F, 0.0F, 0.0F};
};

/// The look of a primitive at its points: its material and vertex attributes, as glTF defines them, and
/// textures by their nearest texel.
struct PrimitiveLook {
    const scenes::Item* item = nullptr;
    const scenes::Material* material = nullptr;  ///< null: white
    const scenes::Texture* texture = nullptr;    ///< null: no texture
    const scenes::Image* image = nullptr;        ///< null: no texture

    PrimitiveLook(const scenes::Scene& scene, const scenes::Item& item);

    [[nodiscard]] glm::vec3 color_at(const TrianglePoint& point) const;  ///< linear colour
    [[nodiscard]] float alpha_at(const TrianglePoint& point) const;
    /// Unit normal in the world: interpolated, or the triangle's if its corners have no normals.
    [[nodiscard]] glm::dvec3 normal_at(const TrianglePoint& point) const;

private:
    [[nodiscard]] glm::vec4 texel_at(const TrianglePoint& point) const;
    [[nodiscard]] glm::vec4 vertex_color_at(const TrianglePoint& point) const;
};

/// A snapshot's triangles as Embree holds them. Positions are relative to the middle of the scene, which
/// keeps the rounding of floats small. Alpha masks let rays through where the nearest texel fails the cutoff.
struct TracedScene {
    /// Scene and snapshot must outlive it. @throws Error  Fault::memory if Embree cannot hold the triangles.
    TracedScene(const scenes::Scene& scene, const scenes::Snapshot& snapshot);

    EmbreeDevice device;
    EmbreeScene tree;
    std::vector<PrimitiveLook> looks;           ///< one per geometry; Embree holds pointers to them
    std::vector<std::uint32_t> first_triangle;  ///< per geometry, counted through the items
    glm::dvec3 centre{0.0};
    double size = 1.0;  ///< diagonal of the bounds
    double build_milliseconds = 0.0;

private:
    void add(const scenes::Item& item, const PrimitiveLook& look);
};

/// Sets all fields of a ray.
void set_ray(RTCRay& ray, const glm::vec3& origin, const glm::vec3& direction, float near, float far);

/// The rays of a picture's pixels, and the shadow rays from the points that they hit. Points are relative to
/// the scene's middle.
class PictureRays {
public:
    PictureRays(const optics::Camera& camera, const optics::Light& light, const TracedScene& scene,
                glm::ivec2 size);

    /// Unit direction of a pixel's ray. @param place  in pixels from the top left corner; centres lie at
    /// halves.
    [[nodiscard]] glm::dvec3 direction(const glm::dvec2& place) const;
    [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
    /// Sets the shadow ray of a point.
    void aim_at_light(RTCRay& ray, const glm::dvec3& point) const;
    /// Unit vector from a point to the light.
    [[nodiscard]] glm::dvec3 towards_light(const glm::dvec3& point) const;

private:
    const optics::Light& light_;
    glm::ivec2 size_;
    glm::dvec3 eye_, centre_, forward_, right_, up_;
    /// Distance from the surface at which shadow rays start, so that they do not meet it again.
    float gap_;
};

}  // namespace cairn::reference

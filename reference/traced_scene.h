#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "reference/embree.h"
#include "reference/image.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {

/// A point on a triangle, by weights of its corners.
struct TrianglePoint {
    unsigned triangle = 0;  ///< its number in the primitive
    glm::vec3 weights{1.0F, 0.0F, 0.0F};
};

/// What a primitive looks like at its points: its material and vertex attributes, as glTF defines them,
/// textures by their nearest texel.
struct PrimitiveLook {
    const scenes::Item* item = nullptr;
    const scenes::Material* material = nullptr;  ///< or null: white
    const scenes::Texture* texture = nullptr;    ///< or null
    const scenes::Image* image = nullptr;        ///< or null

    PrimitiveLook(const scenes::Scene& scene, const scenes::Item& item);

    [[nodiscard]] glm::vec3 color_at(const TrianglePoint& point) const;  ///< linear
    [[nodiscard]] float alpha_at(const TrianglePoint& point) const;
    /// Unit, in the world; the triangle's own where it has none at its corners.
    [[nodiscard]] glm::dvec3 normal_at(const TrianglePoint& point) const;

private:
    [[nodiscard]] glm::vec4 texel_at(const TrianglePoint& point) const;
    [[nodiscard]] glm::vec4 vertex_color_at(const TrianglePoint& point) const;
};

/// A snapshot's triangles as Embree holds them. Positions count from the middle of the scene, where floats
/// hold most of a point. Alpha masks let rays through where the nearest texel fails the cutoff.
struct TracedScene {
    /// Both must outlive it. @throws Error  Fault::memory when Embree cannot hold the triangles.
    TracedScene(const scenes::Scene& scene, const scenes::Snapshot& snapshot);

    EmbreeDevice device;
    EmbreeScene tree;
    std::vector<PrimitiveLook> looks;           ///< one per geometry; Embree points in here
    std::vector<std::uint32_t> first_triangle;  ///< one per geometry, counted through the items
    glm::dvec3 centre{0.0};
    double size = 1.0;  ///< diagonal of the bounds
    double build_milliseconds = 0.0;

private:
    void add(const scenes::Item& item, const PrimitiveLook& look);
};

/// Sets all of a ray but its way.
void set_ray(RTCRay& ray, const glm::vec3& origin, const glm::vec3& direction, float near, float far);

/// The rays of a picture's pixels, and from where they end to the light. Points count from the scene's
/// middle.
class PictureRays {
public:
    PictureRays(const optics::Camera& camera, const optics::Light& light, const TracedScene& scene,
                glm::ivec2 size);

    /// Unit. @param place  in pixels from the top left corner; centres lie at halves.
    [[nodiscard]] glm::dvec3 direction(const glm::dvec2& place) const;
    [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
    /// The shadow ray of a point.
    void aim_at_light(RTCRay& ray, const glm::dvec3& point) const;
    /// Unit, from a point to the light.
    [[nodiscard]] glm::dvec3 towards_light(const glm::dvec3& point) const;

private:
    const optics::Light& light_;
    glm::ivec2 size_;
    glm::dvec3 eye_, centre_, forward_, right_, up_;
    /// Shadow rays start so far from the surface, not to meet it again.
    float gap_;
};

}  // namespace cairn::reference

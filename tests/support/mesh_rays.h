#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/renderer.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "tests/support/test_scenes.h"

/// Rays against triangles, one by one, in double: the truth for rasterized meshes.
namespace cairn::test {

struct WorldTriangle {
    std::array<glm::dvec3, 3> corners;
};

inline std::vector<WorldTriangle> world_triangles(const scenes::Snapshot& snapshot) {
    std::vector<WorldTriangle> all;
    for (const scenes::Item& item : snapshot.items) {
        const std::vector<std::uint32_t>& indices = item.primitive->indices;
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            WorldTriangle& triangle = all.emplace_back();
            for (std::size_t corner = 0; corner < 3; ++corner)
                triangle.corners[corner] = item.world(indices[i + corner]);
        }
    }
    return all;
}

/// Rays through places of a picture: (0.5, 0.5) is the centre of the pixel at the top left.
class PictureRays {
public:
    explicit PictureRays(const renderer::View& view)
        : eye(view.camera.eye), size_(view.size.width, view.size.height) {
        forward_ = glm::normalize(view.camera.target - view.camera.eye);
        const double half = std::tan(0.5 * view.camera.yfov);
        right_ = glm::normalize(glm::cross(forward_, view.camera.up));
        up_ = glm::cross(right_, forward_) * half;
        right_ *= half * view.size.width / view.size.height;
    }
    [[nodiscard]] glm::dvec3 direction(const glm::dvec2& place) const {
        const glm::dvec2 p = place / size_ * 2.0 - 1.0;
        return glm::normalize(forward_ + p.x * right_ - p.y * up_);
    }

    glm::dvec3 eye;

private:
    glm::dvec2 size_;
    glm::dvec3 forward_, right_, up_;
};

struct Face {
    double t = 0.0;
    std::size_t triangle = 0;
    /// Cosine between ray and normal; negative if the front is seen.
    double cosine = 0.0;
};

/// All faces before the origin, nearest first.
inline std::vector<Face> faces_along(const std::vector<WorldTriangle>& triangles, const glm::dvec3& origin,
                                     const glm::dvec3& direction) {
    std::vector<Face> faces;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::dvec3 a = triangles[i].corners[0] - origin;
        const glm::dvec3 b = triangles[i].corners[1] - origin;
        const glm::dvec3 c = triangles[i].corners[2] - origin;
        const double u = glm::dot(direction, glm::cross(b, c));
        const double v = glm::dot(direction, glm::cross(c, a));
        const double w = glm::dot(direction, glm::cross(a, b));
        if (!((u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0))) continue;
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double along = glm::dot(normal, direction);
        if (along == 0.0) continue;
        const double t = glm::dot(normal, a) / along;
        if (t > 0.0) faces.push_back({t, i, along / glm::length(normal)});
    }
    std::sort(faces.begin(), faces.end(), [](const Face& x, const Face& y) { return x.t < y.t; });
    return faces;
}

/// The faces at a pixel's centre; none if another triangle is so close that a rasterizer, which rounds
/// vertices to a 256th of a pixel, may see that triangle.
struct PixelFaces {
    std::vector<Face> faces;
    bool sure = true;
};

inline PixelFaces faces_at(const std::vector<WorldTriangle>& triangles, const PictureRays& rays, int x,
                           int y) {
    constexpr double doubt = 0.02;  // pixels
    const auto at = [&](double dx, double dy) {
        return faces_along(triangles, rays.eye, rays.direction({x + 0.5 + dx, y + 0.5 + dy}));
    };
    PixelFaces out{at(0.0, 0.0), true};
    for (const glm::dvec2 shift : {glm::dvec2(-doubt, -doubt), glm::dvec2(doubt, -doubt),
                                   glm::dvec2(-doubt, doubt), glm::dvec2(doubt, doubt)}) {
        const std::vector<Face> near_by = at(shift.x, shift.y);
        out.sure =
            out.sure && std::equal(near_by.begin(), near_by.end(), out.faces.begin(), out.faces.end(),
                                   [](const Face& a, const Face& b) { return a.triangle == b.triangle; });
    }
    return out;
}

/// A box with its fronts outwards.
inline std::vector<glm::vec3> box_corners(const glm::vec3& low, const glm::vec3& high) {
    std::vector<glm::vec3> corners;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool top : {false, true}) {
            const auto corner = [&](bool u, bool v) {
                glm::vec3 p;
                p[axis] = top ? high[axis] : low[axis];
                p[(axis + 1) % 3] = u ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
                p[(axis + 2) % 3] = v ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
                return p;
            };
            const glm::vec3 a = corner(false, false);
            const glm::vec3 b = corner(true, false);
            const glm::vec3 c = corner(true, true);
            const glm::vec3 d = corner(false, true);
            if (top) {
                corners.insert(corners.end(), {a, b, c, a, c, d});
            } else {
                corners.insert(corners.end(), {a, c, b, a, d, c});
            }
        }
    }
    return corners;
}

/// A scene of triangles in one linear colour.
inline scenes::Scene colored(std::vector<glm::vec3> corners, const glm::vec4& color) {
    scenes::Scene scene = triangles(std::move(corners));
    scenes::Material material;
    material.base_color = color;
    scene.materials.push_back(std::move(material));
    scene.meshes[0].primitives[0].material = 0;
    return scene;
}

/// A quad from four corners, counter-clockwise as seen from the front.
inline std::vector<glm::vec3> quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                                   const glm::vec3& d) {
    return {a, b, c, a, c, d};
}

}  // namespace cairn::test

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/lattice_surface.h"

/// Closed meshes on the lattice, and whether a point is inside them.
namespace cairn::test {

using Mesh = std::vector<LatticeTriangle>;

inline LatticeTriangle turned(const LatticeTriangle& t) {
    return {t[0], t[2], t[1]};
}
inline Mesh turned(Mesh mesh) {
    for (LatticeTriangle& triangle : mesh)
        triangle = turned(triangle);
    return mesh;
}
inline Mesh joined(Mesh a, const Mesh& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// A box of twelve triangles with normals outwards. Each face is cut along either diagonal, and each triangle
/// begins at any corner.
inline Mesh box(const glm::i64vec3& low, const glm::i64vec3& high, Random& random) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (const bool top : {false, true}) {
            std::array<glm::i64vec3, 4> corners;
            for (int i = 0; i < 4; ++i) {
                glm::i64vec3& p = corners[std::size_t(i)];
                p[axis] = top ? high[axis] : low[axis];
                p[u] = i == 1 || i == 2 ? high[u] : low[u];
                p[v] = i >= 2 ? high[v] : low[v];
            }
            const auto c = std::size_t(random.between(0, 3));
            for (const std::size_t second : {std::size_t(1), std::size_t(2)}) {
                LatticeTriangle t{corners[c], corners[(c + second) % 4], corners[(c + second + 1) % 4]};
                if (!top) t = turned(t);
                std::rotate(t.begin(), t.begin() + random.between(0, 2), t.end());
                mesh.push_back(t);
            }
        }
    }
    return mesh;
}

/// A sphere: an octahedron whose sides are halved `depth` times and moved onto the sphere.
inline Mesh sphere(const glm::dvec3& centre, double radius, int depth) {
    std::vector<std::array<glm::dvec3, 3>> faces;
    for (int octant = 0; octant < 8; ++octant) {
        const glm::dvec3 sign((octant & 1) != 0 ? 1 : -1, (octant & 2) != 0 ? 1 : -1,
                              (octant & 4) != 0 ? 1 : -1);
        const bool even = sign.x * sign.y * sign.z > 0;
        const std::array<glm::dvec3, 3> axes{glm::dvec3(sign.x, 0, 0), glm::dvec3(0, sign.y, 0),
                                             glm::dvec3(0, 0, sign.z)};
        faces.push_back({axes[0], axes[even ? 1 : 2], axes[even ? 2 : 1]});
    }
    for (int i = 0; i < depth; ++i) {
        std::vector<std::array<glm::dvec3, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const glm::dvec3 ab = glm::normalize(a + b);
            const glm::dvec3 bc = glm::normalize(b + c);
            const glm::dvec3 ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = finer;
    }
    Mesh mesh;
    for (const auto& face : faces) {
        LatticeTriangle t;
        for (std::size_t i = 0; i < 3; ++i)
            t[i] = glm::i64vec3(glm::round(centre + radius * face[i]));
        mesh.push_back(t);
    }
    return mesh;
}

/// Tetrahedra of either orientation that intersect each other, many with corners on the lines through the
/// voxels' centres.
inline Mesh random_tetrahedra(Random& random, int count, std::int64_t step) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        std::array<glm::i64vec3, 4> p;
        for (glm::i64vec3& corner : p)
            corner = random.point(0, lattice_side / step) * step;
        for (std::size_t face = 0; face < 4; ++face) {
            LatticeTriangle t{p[(face + 1) % 4], p[(face + 2) % 4], p[(face + 3) % 4]};
            if (face % 2 == 1) t = turned(t);
            std::rotate(t.begin(), t.begin() + random.between(0, 2), t.end());
            mesh.push_back(t);
        }
    }
    return mesh;
}

/// How often a mesh winds around a point, by the solid angles of its triangles (van Oosterom and Strackee
/// 1983). Not for points near the surface.
inline double winding_number(const Mesh& mesh, const glm::dvec3& point) {
    double sum = 0.0;
    for (const LatticeTriangle& t : mesh) {
        const glm::dvec3 a = glm::dvec3(t[0]) - point;
        const glm::dvec3 b = glm::dvec3(t[1]) - point;
        const glm::dvec3 c = glm::dvec3(t[2]) - point;
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                   glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (4.0 * std::numbers::pi);
}

}  // namespace cairn::test

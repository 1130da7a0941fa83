#pragma once

#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"

/// Mean colours and normals of voxels: an integral, computed without samples by clipping polygons in double,
/// cell by cell of the texture.
namespace cairn::test {

/// A point of a triangle, with everything that varies linearly over the triangle.
struct TruthVertex {
    glm::dvec3 position{0.0};  ///< in voxels
    glm::dvec3 normal{0.0};
    glm::dvec3 color{1.0};
    glm::dvec2 texcoord{0.0};
};
using TruthPolygon = std::vector<TruthVertex>;

struct TruthTriangle {
    TruthPolygon corners;
    const scenes::Image* image = nullptr;  ///< texture, which repeats
    glm::dvec3 factor{1.0};
    bool masked = false;  ///< texels of alpha < 128 are holes
};

struct TruthVoxel {
    double area = 0.0;  ///< area in faces of a voxel
    glm::dvec3 color{0.0}, normal{0.0};
};

inline TruthVertex between(const TruthVertex& p, const TruthVertex& q, double t) {
    return {glm::mix(p.position, q.position, t), glm::mix(p.normal, q.normal, t),
            glm::mix(p.color, q.color, t), glm::mix(p.texcoord, q.texcoord, t)};
}

/// The part of a polygon where `inside(vertex)` >= 0.
template <typename Inside>
TruthPolygon clipped(const TruthPolygon& polygon, const Inside& inside) {
    TruthPolygon out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const TruthVertex& p = polygon[i];
        const TruthVertex& q = polygon[(i + 1) % polygon.size()];
        const double a = inside(p);
        const double b = inside(q);
        if (a >= 0.0) out.push_back(p);
        if ((a < 0.0) != (b < 0.0)) out.push_back(between(p, q, a / (a - b)));
    }
    return out;
}

inline double linear_of(std::uint8_t srgb) {
    const double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

inline void add_piece(TruthVoxel& voxel, const TruthPolygon& polygon, const glm::dvec3& tint) {
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const TruthVertex& a = polygon[0];
        const TruthVertex& b = polygon[i - 1];
        const TruthVertex& c = polygon[i];
        const double area = 0.5 * glm::length(glm::cross(b.position - a.position, c.position - a.position));
        voxel.area += area;
        voxel.color += area * tint * (a.color + b.color + c.color) / 3.0;
        const glm::dvec3 normal = a.normal + b.normal + c.normal;
        if (glm::length(normal) > 0.0) voxel.normal += area * glm::normalize(normal);
    }
}

inline void add_triangle(TruthVoxel& voxel, const TruthTriangle& triangle, const glm::dvec3& low) {
    TruthPolygon piece = triangle.corners;
    for (int axis = 0; axis < 3; ++axis) {
        piece = clipped(piece, [&](const TruthVertex& v) { return v.position[axis] - low[axis]; });
        piece = clipped(piece, [&](const TruthVertex& v) { return low[axis] + 1.0 - v.position[axis]; });
    }
    if (piece.size() < 3) return;
    if (triangle.image == nullptr) {
        add_piece(voxel, piece, triangle.factor);
        return;
    }
    const scenes::Image& image = *triangle.image;
    const glm::dvec2 size(image.width, image.height);
    glm::dvec2 first(1e30), last(-1e30);
    for (const TruthVertex& v : piece) {
        first = glm::min(first, glm::floor(v.texcoord * size));
        last = glm::max(last, glm::floor(v.texcoord * size));
    }
    for (double row = first.y; row <= last.y; ++row) {
        for (double column = first.x; column <= last.x; ++column) {
            TruthPolygon part =
                clipped(piece, [&](const TruthVertex& v) { return v.texcoord.x * size.x - column; });
            part = clipped(part, [&](const TruthVertex& v) { return column + 1.0 - v.texcoord.x * size.x; });
            part = clipped(part, [&](const TruthVertex& v) { return v.texcoord.y * size.y - row; });
            part = clipped(part, [&](const TruthVertex& v) { return row + 1.0 - v.texcoord.y * size.y; });
            const auto x = std::size_t(column - size.x * std::floor(column / size.x));
            const auto y = std::size_t(row - size.y * std::floor(row / size.y));
            const std::uint8_t* const texel = &image.rgba[4 * (y * std::size_t(image.width) + x)];
            if (triangle.masked && texel[3] < 128) continue;
            add_piece(
                voxel, part,
                triangle.factor * glm::dvec3(linear_of(texel[0]), linear_of(texel[1]), linear_of(texel[2])));
        }
    }
}

/// The attributes of the occupied voxels of the region, in the order of VoxelAttributes.
inline std::vector<TruthVoxel> true_attributes(const std::vector<TruthTriangle>& triangles,
                                               const voxelizer::BitGrid& bits,
                                               const glm::ivec3& region_origin) {
    std::vector<TruthVoxel> out;
    for (int z = 0; z < bits.size.z; ++z) {
        for (int y = 0; y < bits.size.y; ++y) {
            for (int x = 0; x < bits.size.x; ++x) {
                if (!bits.at({x, y, z})) continue;
                TruthVoxel& voxel = out.emplace_back();
                for (const TruthTriangle& triangle : triangles)
                    add_triangle(voxel, triangle, glm::dvec3(region_origin + glm::ivec3(x, y, z)));
            }
        }
    }
    return out;
}

}  // namespace cairn::test

#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "reference/separating_axes.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface.h"

namespace cairn::test {

/// Corners in lattice units; the root cube spans [0, 2^24].
using LatticeTriangle = std::array<glm::i64vec3, 3>;

constexpr std::int64_t lattice_side = std::int64_t(1) << LATTICE_BITS;

/// A cube of `resolution` voxels with its low corner at the world's origin, one unit per voxel.
inline voxelizer::Grid unit_grid(int resolution) {
    return {glm::dvec3(0.0), 1.0, glm::ivec3(resolution)};
}

inline bool within_shader_range(const glm::i64vec3& p) {
    return glm::all(glm::greaterThanEqual(p, glm::i64vec3(-lattice_side))) &&
           glm::all(glm::lessThanEqual(p, glm::i64vec3(2 * lattice_side)));
}

/// A surface of these triangles, as build_surface() would make it.
inline voxelizer::Surface lattice_surface(const std::vector<LatticeTriangle>& triangles, int resolution) {
    voxelizer::Surface surface;
    surface.grid = unit_grid(resolution);
    surface.materials.resize(1);
    surface.triangle_count = triangles.size();
    voxelizer::SurfaceChunk& chunk = surface.chunks.emplace_back();
    for (const LatticeTriangle& triangle : triangles) {
        if (!within_shader_range(triangle[0]) || !within_shader_range(triangle[1]) ||
            !within_shader_range(triangle[2])) {
            surface.far_triangles.push_back({triangle, {}, {}, 0});
            continue;
        }
        const auto first = std::uint32_t(chunk.positions.size());
        for (const glm::i64vec3& p : triangle)
            chunk.positions.push_back({int(p.x), int(p.y), int(p.z)});
        chunk.triangles.push_back({{first, first + 1, first + 2}, 0});
    }
    return surface;
}

/// The truth in its simplest form: every voxel is tested against one triangle.
inline voxelizer::BitGrid voxels_of(const LatticeTriangle& triangle, const voxelizer::Region& region) {
    voxelizer::BitGrid bits(region.size);
    const std::int64_t side = region.voxel_side();
    for (int z = 0; z < region.size.z; ++z) {
        for (int y = 0; y < region.size.y; ++y) {
            for (int x = 0; x < region.size.x; ++x) {
                const glm::i64vec3 low = glm::i64vec3(region.origin + glm::ivec3(x, y, z)) * side;
                if (reference::triangle_meets_box(triangle, low, low + side)) bits.set({x, y, z});
            }
        }
    }
    return bits;
}

inline std::string to_string(const LatticeTriangle& t) {
    std::string out;
    for (const glm::i64vec3& p : t)
        out += fmt::format("({} {} {}) ", p.x, p.y, p.z);
    return out;
}

/// Passes if the bits are the same; else reports how many differ and where the first ones are.
inline ::testing::AssertionResult same_bits(const voxelizer::BitGrid& ours, const voxelizer::BitGrid& truth) {
    if (ours == truth) return ::testing::AssertionSuccess();
    if (ours.size != truth.size) return ::testing::AssertionFailure() << "sizes differ";
    const reference::Comparison comparison = reference::compare(ours, truth);
    ::testing::AssertionResult failure = ::testing::AssertionFailure();
    failure << comparison.missing << " missing, " << comparison.extra << " extra of " << comparison.occupied
            << ":";
    for (const glm::ivec3& v : comparison.first_different) {
        failure << fmt::format(" ({} {} {})", v.x, v.y, v.z) << (ours.at(v) ? " extra" : " missing");
    }
    return failure;
}

/// Random numbers: the same stream with every standard library.
class Random {
public:
    explicit Random(std::uint32_t seed) : bits_(seed) {}
    [[nodiscard]] std::int64_t between(std::int64_t low, std::int64_t high) {
        const std::uint64_t number = std::uint64_t(bits_()) << 32 | bits_();
        return low + std::int64_t(number % std::uint64_t(high - low + 1));
    }
    [[nodiscard]] double unit() { return double(bits_() >> 8) * 0x1p-24; }
    [[nodiscard]] glm::i64vec3 point(std::int64_t low, std::int64_t high) {
        const std::int64_t x = between(low, high);
        const std::int64_t y = between(low, high);
        return {x, y, between(low, high)};
    }

private:
    std::mt19937 bits_;
};

/// Triangles of all kinds in and around the root cube, many with corners on voxel planes.
inline LatticeTriangle random_triangle(Random& random, std::int64_t voxel_side) {
    const std::int64_t margin = lattice_side / 8;
    LatticeTriangle t;
    const std::int64_t kind = random.between(0, 7);
    const std::int64_t reach = kind < 3 ? lattice_side : 3 * voxel_side;
    const glm::i64vec3 centre = random.point(-margin, lattice_side + margin);
    for (glm::i64vec3& p : t)
        p = kind < 3 ? random.point(-margin, lattice_side + margin) : centre + random.point(-reach, reach);
    const std::int64_t snap = random.between(0, 3);
    for (glm::i64vec3& p : t) {
        for (int axis = 0; axis < 3; ++axis) {
            if (snap == 0 || (snap == 1 && random.between(0, 1) == 0))
                p[axis] = p[axis] / voxel_side * voxel_side;
        }
    }
    if (kind == 3) t[1][int(random.between(0, 2))] = t[0][0];          // a side along nothing in particular
    if (kind == 4) t[2] = t[1];                                        // a segment
    if (kind == 5) t[2] = t[1] + (t[1] - t[0]) + random.point(-1, 1);  // a needle, or no area at all
    if (kind == 6) t[1] = t[2] = t[0];                                 // a point
    if (kind == 7) {                                                   // in a plane of constant coordinate
        const int axis = int(random.between(0, 2));
        t[1][axis] = t[2][axis] = t[0][axis];
    }
    return t;
}

}  // namespace cairn::test

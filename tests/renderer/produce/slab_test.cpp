// The slabs of voxels hold all of the surface, and where marks are not kept, slabs tell as much.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "shaders/interop/grid.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;
using glm::dvec3;
using glm::ivec3;

using Polygon = std::vector<dvec3>;

/// The part of a polygon on one side of a plane across an axis (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, int axis, double plane, double side) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3& a = polygon[i];
        const dvec3& b = polygon[(i + 1) % polygon.size()];
        const double at_a = side * (a[axis] - plane);
        const double at_b = side * (b[axis] - plane);
        if (at_a >= 0.0) kept.push_back(a);
        if ((at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0))
            kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    return kept;
}

/// What lies in the cube of side 1 around the origin.
Polygon part_in_voxel(Polygon polygon) {
    for (int axis = 0; axis < 3; ++axis) {
        polygon = clipped(polygon, axis, -0.5, 1.0);
        polygon = clipped(polygon, axis, 0.5, -1.0);
    }
    return polygon;
}

/// The voxels of one brick, with the triangles around them.
class SlabTest : public GlTest {
protected:
    static constexpr int level = 2;

    void produce(const voxelizer::Surface& surface, const Tile& tile) {
        surface_ = &surface;
        tile_ = tile;
        BrickMaker maker(shape_, surface, 1);
        (void)maker.produce_one(tile);
        mip_ = read_mip(maker.pool(), shape_, 0, 0);
        fine_ = reference::exact_voxels(
            surface, {shape_.voxel_level(tile.level) + 2, 4 * first(), ivec3(4 * shape_.m)});
    }

    /// First voxel of the tile.
    [[nodiscard]] ivec3 first() const { return ivec3(tile_.position) * shape_.m; }

    /// Calls visit(place, normals) for each occupied voxel of the brick, border included.
    template <typename Visit>
    void each_voxel(const Visit& visit) const {
        const int m = shape_.m;
        for (int z = -1; z <= m; ++z)
            for (int y = -1; y <= m; ++y)
                for (int x = -1; x <= m; ++x)
                    if (mip_.normal[mip_.index({x, y, z})] != 0) visit(ivec3(x, y, z));
    }

    /// Every vertex of the triangles' parts in voxels lies in the slab. @return the slabs that were looked
    /// at.
    int expect_surface_in_slabs() const {
        const double voxel = 1 << (LATTICE_BITS - shape_.voxel_level(tile_.level));
        const auto& positions = surface_->chunks[0].positions;
        int slabs = 0;
        each_voxel([&](const ivec3& place) {
            const auto slab = slab_of(mip_.normal[mip_.index(place)]);
            if (!slab) return;
            ++slabs;
            for (const interop::SurfaceTriangle& triangle : surface_->chunks[0].triangles) {
                Polygon polygon;
                for (int k = 0; k < 3; ++k) {
                    const auto& p = positions[triangle.vertices[k]];
                    polygon.push_back(dvec3(p[0], p[1], p[2]) / voxel - dvec3(first() + place) - 0.5);
                }
                for (const dvec3& corner : part_in_voxel(polygon)) {
                    const double height = glm::dot(slab->normal, corner);
                    EXPECT_TRUE(height >= slab->low - 1e-9 && height <= slab->high + 1e-9)
                        << fmt::format("voxel ({} {} {}): the surface is at {}, the slab from {} to {}",
                                       place.x, place.y, place.z, height, slab->low, slab->high);
                }
            }
        });
        return slabs;
    }

    [[nodiscard]] bool is_fine_set(const ivec3& place, int i) const {
        return fine_.at(4 * place + ivec3(i % 4, i / 4 % 4, i / 16));
    }

    /// Marks that are kept are those of the exact finer voxels, or more; where they are not kept, the slab
    /// reaches into none that is not set by more than a twentieth of a voxel's corner height. @return voxels
    /// without marks.
    int expect_marks_or_enough() const {
        int without = 0;
        each_voxel([&](const ivec3& place) {
            if (glm::any(glm::lessThan(place, ivec3(0))) ||
                glm::any(glm::greaterThanEqual(place, ivec3(shape_.m))))
                return;
            const auto marks = mip_.marks[mip_.index(place)];
            const auto slab = slab_of(mip_.normal[mip_.index(place)]);
            if (!marks) {
                ++without;
                ASSERT_TRUE(slab.has_value());
            }
            for (int i = 0; i < 64; ++i) {
                if (marks) {
                    EXPECT_TRUE(!is_fine_set(place, i) || (*marks >> unsigned(i) & 1U) != 0) << fmt::format(
                        "voxel ({} {} {}), finer voxel {}: marks {:x}", place.x, place.y, place.z, i, *marks);
                    continue;
                }
                const dvec3 centre = (dvec3(i % 4, i / 4 % 4, i / 16) - 1.5) * 0.25;
                const dvec3 size = glm::abs(slab->normal);
                const double corners = size.x + size.y + size.z;
                const double middle = glm::dot(slab->normal, centre);
                const double reach = (0.125 - 0.05) * corners;
                const bool meets = middle + reach > slab->low + 1e-6 && middle - reach < slab->high - 1e-6;
                EXPECT_TRUE(!meets || is_fine_set(place, i))
                    << fmt::format("voxel ({} {} {}), finer voxel {}", place.x, place.y, place.z, i);
            }
        });
        return without;
    }

    TreeShape shape_ = make_tree_shape_within(4, 16, 65536);
    const voxelizer::Surface* surface_ = nullptr;
    Tile tile_;
    ProducedMip mip_;
    voxelizer::BitGrid fine_;
};

TEST_F(SlabTest, HoldTheSurfaceOfRandomTriangles) {
    int slabs = 0;
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        Random random(seed);
        std::vector<LatticeTriangle> triangles;
        for (int i = 0; i < 60; ++i)
            triangles.push_back(random_triangle(random, lattice_side >> random.between(2, 7)));
        voxelizer::Surface surface = lattice_surface(triangles, 4096);
        surface.far_triangles.clear();  // not in bricks
        produce(surface, {level, random.point(4, 11)});
        slabs += expect_surface_in_slabs();
        (void)expect_marks_or_enough();
        if (HasFailure()) return;
    }
    EXPECT_GT(slabs, 500);
}

TEST_F(SlabTest, OfAPlaneAreThinAndNeedNoMarks) {
    // A plane through the whole cube at a slant, in two triangles.
    const auto height = [](double x, double y) { return 0.31 + 0.23 * x + 0.11 * y; };
    const auto at = [&](double x, double y) {
        return glm::i64vec3(dvec3(x, y, height(x, y)) * double(lattice_side));
    };
    const voxelizer::Surface surface =
        lattice_surface({{at(0, 0), at(1, 0), at(1, 1)}, {at(0, 0), at(1, 1), at(0, 1)}}, 4096);
    produce(surface, {level, {7, 5, std::int64_t(16 * height(7.5 / 16, 5.5 / 16))}});
    EXPECT_GT(expect_surface_in_slabs(), 200);
    int voxels = 0;
    each_voxel([&](const ivec3& place) {
        const auto slab = slab_of(mip_.normal[mip_.index(place)]);
        ASSERT_TRUE(slab.has_value());
        const dvec3 size = glm::abs(slab->normal);
        // Its normal is rounded by half a step of the octahedral map, and its planes to steps outwards.
        EXPECT_LE(slab->high - slab->low, 3.01 / 64.0 * (size.x + size.y + size.z));
        ++voxels;
    });
    EXPECT_GT(voxels, 200);
    EXPECT_GT(expect_marks_or_enough(), 9 * voxels / 20) << "half of the voxels are in the border";
}

TEST_F(SlabTest, EdgesOfASurfaceKeepTheirMarks) {
    // A square whose edge lies in the middle of voxels: there, the slab alone would go on to the voxels'
    // ends.
    const double edge = (5 + 8.5 / 16) / 16.0;
    const auto at = [&](double x, double y) {
        return glm::i64vec3(dvec3(x, y, 0.3371) * double(lattice_side));
    };
    const voxelizer::Surface surface =
        lattice_surface({{at(0, 0), at(edge, 0), at(edge, 1)}, {at(0, 0), at(edge, 1), at(0, 1)}}, 4096);
    produce(surface, {level, {5, 5, 5}});
    (void)expect_surface_in_slabs();
    constexpr int last = 8;
    int at_edge = 0;
    each_voxel([&](const ivec3& place) {
        if (glm::any(glm::lessThan(place, ivec3(0))) || glm::any(glm::greaterThanEqual(place, ivec3(16))))
            return;
        EXPECT_EQ(mip_.marks[mip_.index(place)].has_value(), place.x == last) << "x = " << place.x;
        at_edge += place.x == last ? 1 : 0;
    });
    EXPECT_EQ(at_edge, 16);
}

}  // namespace
}  // namespace cairn::renderer

// The mips of a brick are the same as a brick with voxels of their size, bit for bit.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/pool/brick_pool.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/surface.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

struct Shape {
    int n, m;
    bool has_color;
};

class BrickMips : public GlTest, public ::testing::WithParamInterface<Shape> {
protected:
    [[nodiscard]] static TreeShape shape() {
        return make_tree_shape(GetParam().n, GetParam().m, 65536, true);
    }
    [[nodiscard]] static voxelizer::Surface surface(std::uint32_t seed) {
        Random random(seed);
        std::vector<LatticeTriangle> triangles;
        for (int i = 0; i < 300; ++i)
            triangles.push_back(random_triangle(random, lattice_side >> random.between(4, 10)));
        voxelizer::Surface out = lattice_surface(triangles, 4096);
        for (voxelizer::SurfaceChunk& chunk : out.chunks) {
            chunk.attributes.assign(chunk.positions.size(),
                                    voxelizer::surface_attributes(0, glm::u16vec4(65535), glm::vec2(0.0F)));
            for (interop::SurfaceTriangle& triangle : chunk.triangles)
                triangle.material = std::uint32_t(random.between(0, 1));
        }
        out.has_color = GetParam().has_color;
        out.materials.assign(2, {});
        out.materials[0].base_color = {0.9F, 0.2F, 0.1F, 1.0F};
        out.materials[1].base_color = {0.1F, 0.5F, 0.8F, 1.0F};
        return out;
    }
};

TEST_P(BrickMips, CoarsestMipIsTheMatchingPartOfTheParentsBrick) {
    const voxelizer::Surface all = surface(61);
    const TreeShape tree = shape();
    std::vector<Tile> tiles = {Tile{}};
    for (int child = 0; child < tree.child_count(); ++child)
        tiles.push_back(child_of(Tile{}, tree.n, child));
    BrickMaker maker(tree, all, int(tiles.size()) * 2 + 8);
    (void)maker.produce(tiles);
    const ProducedMip parent = read_mip(maker.pool(), tree, 0, 0);
    std::size_t occupied = 0;
    for (std::size_t i = 1; i < tiles.size(); ++i) {
        if (maker.pool().packed()->run(int(i)).words == 0) continue;  // its border is not kept either
        const ProducedMip mip = read_mip(maker.pool(), tree, int(i), tree.mips);
        const int m = tree.m >> tree.mips;
        const glm::ivec3 low = glm::ivec3(tiles[i].position) * m;
        for (int k = 0; k < mip.side * mip.side * mip.side; ++k) {
            const glm::ivec3 place =
                glm::ivec3(k % mip.side, k / mip.side % mip.side, k / (mip.side * mip.side)) - 1;
            const auto where =
                fmt::format("seed 61, child {}, voxel {} {} {}", i - 1, place.x, place.y, place.z);
            ASSERT_EQ(mip.color[mip.index(place)], parent.color[parent.index(low + place)]) << where;
            ASSERT_EQ(mip.normal[mip.index(place)], parent.normal[parent.index(low + place)]) << where;
            if (glm::any(glm::lessThan(place, glm::ivec3(0))) ||
                glm::any(glm::greaterThanEqual(place, glm::ivec3(m))))
                continue;
            ASSERT_EQ(mip.occupied_at(place), parent.occupied_at(low + place)) << where;
            occupied += mip.occupied_at(place) ? 1 : 0;
        }
    }
    EXPECT_GT(occupied, 50U);
}

TEST_P(BrickMips, NeighboursAgreeOnTheirBordersAtEveryMip) {
    const voxelizer::Surface all = surface(62);
    const TreeShape tree = shape();
    const std::vector<Tile> tiles = {{1, {0, 0, 0}}, {1, {1, 0, 0}}, {1, {0, 1, 0}}, {1, {0, 0, 1}}};
    BrickMaker maker(tree, all, 16);
    (void)maker.produce(tiles);
    for (int mip = 0; mip <= tree.mips; ++mip) {
        const int m = tree.m >> mip;
        const ProducedMip first = read_mip(maker.pool(), tree, 0, mip);
        for (int axis = 0; axis < 3; ++axis) {
            const ProducedMip next = read_mip(maker.pool(), tree, axis + 1, mip);
            for (int i = 0; i < 2 * (m + 2) * (m + 2); ++i) {
                // The last voxels and the border of one are the border and the first voxels of the other.
                glm::ivec3 place(0);
                place[axis] = m - 1 + i % 2;
                place[(axis + 1) % 3] = i / 2 % (m + 2) - 1;
                place[(axis + 2) % 3] = i / 2 / (m + 2) - 1;
                glm::ivec3 there = place;
                there[axis] -= m;
                const auto where = fmt::format("seed 62, mip {}, axis {}, voxel {} {} {}", mip, axis, place.x,
                                               place.y, place.z);
                ASSERT_EQ(first.color[first.index(place)], next.color[next.index(there)]) << where;
                ASSERT_EQ(first.normal[first.index(place)], next.normal[next.index(there)]) << where;
            }
        }
    }
}

TEST_P(BrickMips, VoxelIsOccupiedWhereAFinerOneInItIs) {
    const voxelizer::Surface all = surface(63);
    const TreeShape tree = shape();
    BrickMaker maker(tree, all, 8);
    (void)maker.produce({{1, {1, 1, 1}}});
    for (int mip = 1; mip <= tree.mips; ++mip) {
        const ProducedMip coarse = read_mip(maker.pool(), tree, 0, mip);
        const ProducedMip fine = read_mip(maker.pool(), tree, 0, mip - 1);
        const int m = tree.m >> mip;
        for (int i = 0; i < m * m * m; ++i) {
            const glm::ivec3 v(i % m, i / m % m, i / (m * m));
            bool any = false;
            for (int k = 0; k < 8; ++k)
                any |= fine.occupied_at(2 * v + glm::ivec3(k & 1, k >> 1 & 1, k >> 2));
            ASSERT_EQ(coarse.occupied_at(v), any)
                << "seed 63, mip " << mip << ", voxel " << v.x << ' ' << v.y << ' ' << v.z;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, BrickMips,
                         ::testing::Values(Shape{4, 16, true}, Shape{4, 8, false}, Shape{2, 8, true},
                                           Shape{2, 16, false}, Shape{4, 32, true}, Shape{8, 8, false},
                                           Shape{8, 16, true}),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}{}", shape.param.n, shape.param.m,
                                                shape.param.has_color ? "Colour" : "");
                         });

}  // namespace
}  // namespace cairn::renderer

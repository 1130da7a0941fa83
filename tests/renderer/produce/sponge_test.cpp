// Menger's sponge as a content (renderer/produce/fractal_content.h): its closed form against its definition,
// its bricks against the closed form, and its picture against areas that are known by hand.
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/open_content.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/produce/fractal_content.h"
#include "renderer/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/produced_brick.h"

namespace cairn::test {
namespace {

using renderer::Tile;

using Cubes = std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>>;

/// The definition: the middle cubes of each cube's faces and of its inside are removed.
Cubes cut_out(int level) {
    if (level == 0) return {{0, 0, 0}};
    Cubes cubes;
    for (const auto& [x, y, z] : cut_out(level - 1)) {
        for (int place = 0; place < 27; ++place) {
            const int i = place % 3, j = place / 3 % 3, k = place / 9;
            const bool is_face_or_middle = (i == 1 && j == 1) || (j == 1 && k == 1) || (k == 1 && i == 1);
            if (!is_face_or_middle) cubes.insert({3 * x + i, 3 * y + j, 3 * z + k});
        }
    }
    return cubes;
}

TEST(Sponge, ItsClosedFormIsItsDefinition) {
    for (int level = 0, across = 1; level <= 3; ++level, across *= 3) {
        const Cubes cubes = cut_out(level);
        for (int x = -1; x <= across; ++x) {
            for (int y = -1; y <= across; ++y) {
                for (int z = -1; z <= across; ++z) {
                    ASSERT_EQ(renderer::sponge::occupied({x, y, z}, level), cubes.contains({x, y, z}))
                        << fmt::format("level {}, cube ({}, {}, {})", level, x, y, z);
                }
            }
        }
    }
}

class SpongeBricks : public GlTest, public ::testing::WithParamInterface<int> {};

TEST_P(SpongeBricks, HoldTheSetAndItsNeighbours) {
    const renderer::TreeShape shape = renderer::make_tree_shape(3, GetParam(), 1594323);
    renderer::FractalContent content(shape);
    renderer::BrickPool pool(shape, false, std::size_t(24) << 20U);
    const std::int64_t deep = shape.tiles_across(shape.max_level) / 3;
    const std::vector<Tile> tiles = {{0, glm::i64vec3(0)},
                                     {1, glm::i64vec3(0, 0, 1)},
                                     {2, glm::i64vec3(2, 3, 8)},
                                     {shape.max_level, glm::i64vec3(0, deep - 1, 3 * deep - 1)}};
    std::vector<renderer::BrickRequest> requests;
    for (std::size_t i = 0; i < tiles.size(); ++i)
        requests.push_back({tiles[i], int(i)});
    ASSERT_GE(pool.slot_count(), int(tiles.size()));
    (void)content.producer().produce(requests, pool);
    for (const renderer::BrickRequest& request : requests) {
        const Tile& tile = request.tile;
        ASSERT_TRUE(renderer::sponge::occupied(tile.position, tile.level)) << "else no ray asks for it";
        const ProducedBrick brick = read_brick(pool, shape, request.slot);
        const int side = shape.m + 2;
        for (int number = 0; number < side * side * side; ++number) {
            const glm::ivec3 place =
                glm::ivec3(number % side, number / side % side, number / side / side) - 1;
            const glm::i64vec3 voxel = tile.position * std::int64_t(shape.m) + glm::i64vec3(place);
            const bool is_full = renderer::sponge::occupied(voxel, tile.level + shape.m_shift());
            const auto where =
                fmt::format("level {}, voxel ({}, {}, {})", tile.level, place.x, place.y, place.z);
            ASSERT_EQ(brick.color_at(place).w, is_full ? 255 : 0) << where;
            if (glm::any(glm::lessThan(place, glm::ivec3(0))) ||
                glm::any(glm::greaterThanEqual(place, glm::ivec3(shape.m)))) {
                continue;
            }
            ASSERT_EQ(brick.occupied(place), is_full) << where;
            if (is_full) {
                ASSERT_TRUE(brick.summary_at(place / shape.block_side())) << where;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(M, SpongeBricks, ::testing::Values(27, 81));

TEST_F(GlTest, TheOracleOfTheSpongeKnowsItsTilesExactly) {
    const renderer::TreeShape shape = renderer::make_tree_shape(3, 27, 1594323);
    renderer::FractalOracle oracle(shape);
    for (const Tile tile : {Tile{}, Tile{1, glm::i64vec3(2, 0, 1)}, Tile{2, glm::i64vec3(8, 3, 2)}}) {
        const glm::uvec2 mask = oracle.child_mask(tile);
        for (int child = 0; child < 27; ++child) {
            const Tile inner = child_of(tile, 3, child);
            EXPECT_EQ(renderer::may_hold(mask, 3, child),
                      renderer::sponge::occupied(inner.position, inner.level))
                << "level " << tile.level << ", child " << child;
        }
    }
}

TEST_F(GlTest, TheSpongeHasHolesThatShowTheBackground) {
    renderer::Renderer sponge(renderer::open_content("builtin:sponge"),
                              {.pools = {.brick_bytes = std::size_t(64) << 20U}});
    renderer::View view;
    view.size.width = 91;
    view.size.height = 91;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    // From far, so that its front, [0, 1]^2, is all but the outermost part of the picture.
    view.camera.eye = {0.5, 0.5, 3.0};
    view.camera.target = {0.5, 0.5, 0.5};
    view.camera.yfov = 2.0 * std::atan(0.5 / 2.0);
    const optics::Image image = sponge.render(view).image;
    auto alpha = [&](double x, double y) {  // opacity at a place of the front
        const auto column = std::size_t(x * 91.0);
        const auto row = std::size_t((1.0 - y) * 91.0);
        return int(image.rgba[4 * (row * 91 + column) + 3]);
    };
    EXPECT_EQ(alpha(0.5, 0.5), 0);
    EXPECT_EQ(alpha(0.45, 0.52), 0);
    for (const auto& [x, y] : {std::pair(0.03, 0.03), std::pair(0.97, 0.03), std::pair(0.05, 0.5)})
        EXPECT_EQ(alpha(x, y), 255) << x << ", " << y;
}

}  // namespace
}  // namespace cairn::test

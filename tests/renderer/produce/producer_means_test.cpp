// Colours and normals of bricks are means over the surface in a voxel: against an integral over clipped
// polygons (attribute_truth.h), and against tones that are known.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/attribute_truth.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/painted.h"
#include "tests/support/produced_brick.h"
#include "tests/support/textured_scene.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

constexpr int tree_n = 2;
constexpr int brick_m = 16;

/// Calls see(place of the voxel in its level, brick, place in the brick) for all occupied voxels of a level.
void for_each_voxel(
    const Painted& painted, int resolution, int level,
    const std::function<void(const glm::ivec3&, const ProducedBrick&, const glm::ivec3&)>& see) {
    const TreeShape shape = make_tree_shape(tree_n, brick_m, resolution);
    const voxelizer::Surface surface = painted.surface(unit_cube(resolution));
    const int across = shape.tiles_across(level);
    std::vector<Tile> tiles;
    for (int i = 0; i < across * across * across; ++i)
        tiles.push_back({level, {i % across, i / across % across, i / (across * across)}});
    BrickMaker maker(shape, surface, int(tiles.size()));
    const std::vector<ProducedBrick> bricks = maker.produce(tiles);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        for (int v = 0; v < brick_m * brick_m * brick_m; ++v) {
            const glm::ivec3 place(v % brick_m, v / brick_m % brick_m, v / (brick_m * brick_m));
            if (bricks[i].occupied(place))
                see(glm::ivec3(tiles[i].position) * brick_m + place, bricks[i], place);
        }
    }
}

/// The encoded colour of a voxel: square roots of linear colours, 0 to 255.
glm::dvec3 shown_color(const ProducedBrick& brick, const glm::ivec3& place) {
    const glm::dvec4 texel(brick.color_at(place));
    return 255.0 * glm::dvec3(texel) / std::max(texel.a, 1.0);
}

/// Errors of voxels against the integral, in steps of 1/255 of the encoded colour.
struct MeanErrors {
    double sum_squares = 0.0;
    double most = 0.0;
    int voxels = 0;
    [[nodiscard]] double rms() const { return std::sqrt(sum_squares / std::max(voxels, 1)); }
};

MeanErrors errors_of(const Painted& painted, int resolution, int level) {
    const int across = brick_m << level;
    const voxelizer::Grid grid = unit_cube(across);
    const std::vector<TruthTriangle> triangles = painted.truth(grid);
    MeanErrors errors;
    for_each_voxel(painted, resolution, level,
                   [&](const glm::ivec3& voxel, const ProducedBrick& brick, const glm::ivec3& place) {
                       TruthVoxel truth;
                       for (const TruthTriangle& triangle : triangles)
                           add_triangle(truth, triangle, glm::dvec3(voxel));
                       if (truth.area < 0.25) return;  // a corner of surface, which few samples see
                       const glm::dvec3 right = 255.0 * glm::sqrt(truth.color / truth.area);
                       const glm::dvec3 off = glm::abs(shown_color(brick, place) - right);
                       const double most = std::max({off.x, off.y, off.z});
                       errors.sum_squares += most * most;
                       errors.most = std::max(errors.most, most);
                       ++errors.voxels;
                   });
    return errors;
}

/// A quad through the unit cube, turned about its diagonal; its picture is repeated `repeats` times.
Painted tilted_quad(double turn, double repeats) {
    Painted painted;
    painted.with_normals = false;
    const glm::dvec3 across(0.9 * std::cos(turn), 0.9 * std::sin(turn), 0.1);
    const glm::dvec3 along(-0.2 * std::sin(turn), 0.3 * std::cos(turn), 0.8);
    const glm::dvec3 low = glm::dvec3(0.5) - 0.5 * (across + along);
    const auto corner = [&](double u, double v) {
        painted.add_vertex(glm::vec3(low + u * across + v * along), glm::vec3(0.0F), glm::u8vec3(255),
                           glm::vec2(glm::dvec2(u, v) * repeats));
    };
    for (const auto& [u, v] :
         {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
        corner(u, v);
    return painted;
}

const std::vector<double> turns = {0.0, 0.3, 0.785398, 1.2};

class ProducedMeans : public GlTest {};

TEST_F(ProducedMeans, CheckerboardOfSingleTexelsIsOneTone) {
    for (const double turn : turns) {
        Painted painted = tilted_quad(turn, 1.0);
        painted.use_image(512, 512, checkerboard(512, opaque_white, opaque_black), scenes::AlphaMode::opaque);
        int seen = 0;
        for (const int level : {0, 1, 2}) {  // voxels of 32, 16 and 8 texels
            const double tone = 255.0 * std::sqrt(0.5);
            for_each_voxel(painted, 64, level,
                           [&](const glm::ivec3& voxel, const ProducedBrick& brick, const glm::ivec3& place) {
                               ++seen;
                               const glm::dvec3 shown = shown_color(brick, place);
                               // A low coverage has few steps.
                               const double step = 0.5 * 255.0 / brick.color_at(place).a;
                               ASSERT_NEAR(shown.r, tone, 3.0 + step)
                                   << fmt::format("turn {}, level {}, voxel {} {} {}", turn, level, voxel.x,
                                                  voxel.y, voxel.z);
                           });
        }
        EXPECT_GT(seen, 500);
    }
}

TEST_F(ProducedMeans, AWallThatFillsALargeBrickIsWholeWhateverItsTextureTakes) {
    constexpr int side = 64;  // a pair of triangle and row has 66 voxels
    for (const scenes::AlphaMode mode : {scenes::AlphaMode::opaque, scenes::AlphaMode::mask}) {
        Painted painted;
        for (const auto& [u, v] :
             {std::pair{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}})
            painted.add_vertex({u, v, 0.3F}, glm::vec3(0.0F), glm::u8vec3(255), glm::vec2(u, 40.0F * v));
        painted.use_image(512, 512, checkerboard(512, opaque_white, opaque_white), mode);
        const TreeShape shape = make_tree_shape(2, side, side);
        const voxelizer::Surface surface = painted.surface(unit_cube(side));
        BrickMaker maker(shape, surface, 1);
        const ProducedBrick brick = maker.produce_one({});
        const int z = int(0.3 * side);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                ASSERT_TRUE(brick.occupied({x, y, z})) << x << ", " << y;
                ASSERT_NEAR(shown_color(brick, {x, y, z}).g, 255.0, 1.0) << x << ", " << y;
            }
        }
    }
}

TEST_F(ProducedMeans, StretchedTexturesAreMeansToo) {
    // A texel is 64 times as long as it is wide.
    Painted painted = tilted_quad(0.5, 1.0);
    painted.use_image(
        1024, 16,
        [] {
            std::vector<std::uint8_t> rgba;
            for (int i = 0; i < 1024 * 16; ++i) {
                const std::uint8_t tone = i % 2 == 0 ? 255 : 0;
                rgba.insert(rgba.end(), {tone, tone, tone, 255});
            }
            return rgba;
        }(),
        scenes::AlphaMode::opaque);
    int seen = 0;
    for_each_voxel(painted, 64, 1,
                   [&](const glm::ivec3& voxel, const ProducedBrick& brick, const glm::ivec3& place) {
                       ++seen;
                       const double step = 0.5 * 255.0 / brick.color_at(place).a;
                       ASSERT_NEAR(shown_color(brick, place).r, 255.0 * std::sqrt(0.5), 3.0 + step)
                           << fmt::format("voxel {} {} {}", voxel.x, voxel.y, voxel.z);
                   });
    EXPECT_GT(seen, 100);
}

TEST_F(ProducedMeans, ColoursThatAMaskHidesAreNowhere) {
    for (const double turn : turns) {
        for (const int texels : {16, 64, 512}) {
            Painted painted = tilted_quad(turn, 1.0);
            painted.use_image(texels, texels, checkerboard(texels, kept_green, hidden_magenta),
                              scenes::AlphaMode::mask);
            int seen = 0;
            for (const int level : {0, 1, 2}) {
                for_each_voxel(
                    painted, 64, level,
                    [&](const glm::ivec3& voxel, const ProducedBrick& brick, const glm::ivec3& place) {
                        const glm::ivec4 texel = brick.color_at(place);
                        ++seen;
                        ASSERT_EQ(texel.r, 0) << fmt::format(
                            "turn {}, {} texels, level {}, voxel {} {} {}: {} {} {}", turn, texels, level,
                            voxel.x, voxel.y, voxel.z, texel.r, texel.g, texel.b);
                        ASSERT_EQ(texel.b, 0);
                    });
            }
            EXPECT_GT(seen, 500);
        }
    }
}

TEST_F(ProducedMeans, MaskByVertexAlphaHidesItsColoursToo) {
    // Texels of alpha 200 pass by themselves, and not under a vertex alpha of a half.
    Painted painted = tilted_quad(0.3, 1.0);
    painted.use_image(64, 64, checkerboard(64, kept_green, glm::u8vec4(255, 0, 255, 200)),
                      scenes::AlphaMode::mask);
    painted.scene.materials[0].alpha_cutoff = 0.45F;
    for (glm::u16vec4& color : painted.primitive.colors)
        color.a = 32768;
    int seen = 0;
    for_each_voxel(painted, 64, 1,
                   [&](const glm::ivec3&, const ProducedBrick& brick, const glm::ivec3& place) {
                       ++seen;
                       ASSERT_EQ(brick.color_at(place).r, 0);
                   });
    EXPECT_GT(seen, 100);
}

TEST_F(ProducedMeans, TexturedTrianglesOfAllSizesAreNearTheIntegral) {
    Painted painted = random_triangles(7, 60, false);
    painted.use_image(64, 64, smooth_image(64), scenes::AlphaMode::opaque);
    // The texture has a period per few voxels. One texel in the middle of each part was off by 17.9, 9.7
    // and 5.9.
    for (const auto& [level, most] : {std::pair{0, 13.0}, {1, 9.2}, {2, 5.0}}) {
        const MeanErrors errors = errors_of(painted, 64, level);
        EXPECT_GT(errors.voxels, 100);
        EXPECT_LT(errors.rms(), most) << "level " << level << ", " << errors.voxels << " voxels";
    }
}

TEST_F(ProducedMeans, SmallTrianglesWeighByTheirAreas) {
    // Triangles of about a quarter to a hundredth of a voxel: all that a coarse level has.
    Random random(11);
    Painted painted;
    painted.with_normals = false;
    const auto unit = [&] { return float(random.unit()); };
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 middle(0.2F + 0.6F * unit(), 0.2F + 0.6F * unit(), 0.5F + 0.02F * unit());
        const bool is_large = i % 8 == 0;
        const float size = is_large ? 0.04F : 0.008F;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 offset(unit() - 0.5F, unit() - 0.5F, 0.2F * (unit() - 0.5F));
            painted.add_vertex(middle + size * offset, glm::vec3(0.0F),
                               is_large ? glm::u8vec3(255, 0, 0) : glm::u8vec3(0, 0, 255), glm::vec2(0.0F));
        }
    }
    const MeanErrors errors = errors_of(painted, 64, 0);
    EXPECT_GT(errors.voxels, 50);
    EXPECT_LT(errors.rms(), 4.0) << errors.voxels << " voxels";
    EXPECT_LT(errors.most, 15.0);
}

TEST_F(ProducedMeans, DarkVertexColoursKeepTheirSteps) {
    for (const std::uint16_t dark : {6, 20, 60, 200}) {  // of 65535: 1 is the darkest that 8 bits hold here
        Painted painted = tilted_quad(0.3, 1.0);
        for (glm::u16vec4& color : painted.primitive.colors)
            color = glm::u16vec4(dark, 65535, 65535, 65535);
        int seen = 0;
        for_each_voxel(painted, 32, 1,
                       [&](const glm::ivec3&, const ProducedBrick& brick, const glm::ivec3& place) {
                           if (brick.color_at(place).a < 255) return;
                           ++seen;
                           ASSERT_NEAR(brick.color_at(place).r, 255.0 * std::sqrt(dark / 65535.0), 1.0);
                       });
        EXPECT_GT(seen, 50);
    }
}

}  // namespace
}  // namespace cairn::renderer

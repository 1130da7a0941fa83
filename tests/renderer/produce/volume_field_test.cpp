// Means, which fill bricks of volumes, and bounds and masks, by which tiles are empty.
#include <memory>
#include <random>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/made_fields.h"
#include "renderer/produce/volume_content.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/volume_scenes.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

struct Named {
    std::string name;
    std::shared_ptr<const Field> field;
};

std::vector<Named> fields(int n) {
    const auto dense = std::make_shared<DenseField>(blobs({37, 20, 29}, 21, 5), n);
    return {{"dense", dense},
            {"shell", std::make_shared<HollowSphere>(n, 64, 0.2, 0.3)},
            {"ball", std::make_shared<HollowSphere>(n, 50, 0.0, 0.5)},
            {"copies", std::make_shared<RepeatedField>(dense, 3)}};
}

float value_at(const Field& field, int coarseness, const glm::i64vec3& voxel) {
    float value = 0.0F;
    field.fill(coarseness, voxel, glm::ivec3(1), &value);
    return value;
}

class Numbers {
public:
    explicit Numbers(unsigned seed) : rng_(seed) {}
    std::int64_t between(std::int64_t low, std::int64_t high) {
        return low + std::int64_t(rng_() % std::uint64_t(high - low + 1));
    }

private:
    std::mt19937 rng_;
};

TEST(VolumeFields, RangeHoldsEveryVoxelOfEveryCoarsenessInItsBox) {
    Numbers random(22);
    for (const int n : {2, 3, 4}) {
        for (const Named& named : fields(n)) {
            const std::int64_t longest = named.field->frame().size.x;
            for (int i = 0; i < 3000; ++i) {
                const int coarseness = int(random.between(0, 4));
                const auto side = std::int64_t(std::llround(std::pow(n, coarseness)));
                const auto place = [&] { return random.between(-2, longest / side + 2); };
                const glm::i64vec3 voxel(place(), place(), place());
                const auto more = [&] { return random.between(0, 9); };
                const glm::i64vec3 low = voxel * side - glm::i64vec3(more(), more(), more());
                const glm::i64vec3 high =
                    (voxel + std::int64_t(1)) * side + glm::i64vec3(more(), more(), more());
                const FieldRange range = named.field->range(low, high);
                const float value = value_at(*named.field, coarseness, voxel);
                const float rounded = 1.0F / 65535.0F;  // precision of a level
                ASSERT_GE(value, range.low - rounded) << named.name << ", seed 22, n " << n << ", turn " << i;
                ASSERT_LE(value, range.high + rounded)
                    << named.name << ", seed 22, n " << n << ", turn " << i;
            }
        }
    }
}

TEST(VolumeFields, CoarserVoxelIsTheMeanOfTheFinerOnes) {
    Numbers random(23);
    for (const int n : {2, 3, 4}) {
        for (const Named& named : fields(n)) {
            if (named.name == "shell" || named.name == "ball") continue;  // theirs are means along the radius
            const std::int64_t longest = named.field->frame().size.x;
            for (int i = 0; i < 300; ++i) {
                const int coarseness = int(random.between(1, 4));
                const auto side = std::int64_t(std::llround(std::pow(n, coarseness)));
                const auto place = [&] { return random.between(-1, longest / side + 1); };
                const glm::i64vec3 voxel(place(), place(), place());
                std::vector<float> finer(std::size_t(n * n * n));
                named.field->fill(coarseness - 1, voxel * std::int64_t(n), glm::ivec3(n), finer.data());
                double mean = 0.0;
                for (const float value : finer)
                    mean += value / double(finer.size());
                ASSERT_NEAR(value_at(*named.field, coarseness, voxel), mean, 1.0 / 65535.0)
                    << named.name << ", seed 23, n " << n << ", turn " << i;
            }
        }
    }
}

TEST(VolumeFields, SamplesOfEvenSpacingAreKeptAndOthersAreInterpolated) {
    const scenes::Volume volume = blobs({16, 16, 8}, 24);
    const DenseField even(volume, 2);
    EXPECT_EQ(even.frame().size, glm::i64vec3(16, 16, 8));
    EXPECT_EQ(value_at(even, 0, {5, 7, 3}), float(volume.samples[5 + 16 * (7 + 16 * 3)]) / 65535.0F);
    scenes::Volume stretched = volume;
    stretched.spacing.z *= 2.0;
    const DenseField field(stretched, 2);
    EXPECT_EQ(field.frame().size, glm::i64vec3(16, 16, 16));
    EXPECT_EQ(field.frame().voxel_size, volume.spacing.x);
    // Voxel 7 lies a quarter of the way from sample 3 to sample 4.
    const double expected =
        (0.75 * volume.samples[5 + 16 * (7 + 16 * 3)] + 0.25 * volume.samples[5 + 16 * (7 + 16 * 4)]) /
        65535.0;
    EXPECT_NEAR(value_at(field, 0, {5, 7, 7}), expected, 1.0 / 65535.0);
}

TEST(VolumeFields, ShapeHoldsTheFieldOrIsCutOffAtTheLimit) {
    const FieldFrame frame{2, glm::dvec3(0.0), 1.0, glm::i64vec3(300, 20, 20)};
    const VolumeShape whole = make_volume_shape(frame, 2, 16, 8192);
    EXPECT_EQ(whole.tree.resolution(), 512);
    EXPECT_EQ(whole.finest_coarseness, 0);
    const VolumeShape cut = make_volume_shape(frame, 2, 16, 100);
    EXPECT_EQ(cut.tree.resolution(), 128);  // holds 75 voxels of four samples each
    EXPECT_EQ(cut.finest_coarseness, 2);
    EXPECT_EQ(cut.coarseness(0), whole.coarseness(0));
    EXPECT_THROW((void)make_volume_shape(frame, 4, 16, 8192), Error);
}

class VolumeBricks : public GlTest {};

/// Densities below this one of the 255 steps do not show.
TransferFunction visible_from(int density) {
    return TransferFunction({{(density - 1) / 255.0, glm::dvec3(1.0), 0.0}, {1.0, glm::dvec3(1.0), 1.0}});
}

/// Whether the mask bit of any voxel of the tile's brick is set.
bool shows(const Tile& tile, VolumeContent& content, BrickPool& pool) {
    const BrickRequest request{tile, 0};
    (void)content.producer().produce({&request, 1}, pool);
    pool.bind_for_writing();
    GLint buffer = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 0, &buffer);
    std::vector<std::uint64_t> words(pool.mask_words());
    glGetNamedBufferSubData(GLuint(buffer), 0, GLsizeiptr(words.size() * 8), words.data());
    return std::any_of(words.begin(), words.end(), [](std::uint64_t word) { return word != 0; });
}

TEST_F(VolumeBricks, OfTilesThatTheOracleCallsEmptyAreEmptyAtAllLevelsBelow) {
    for (const int n : {2, 4}) {
        for (const Named& named : fields(n)) {
            const VolumeShape shape = make_volume_shape(named.field->frame(), n, 8, 256);
            VolumeContent content(shape, named.field, visible_from(60));
            BrickPool pool(shape.tree, content.channels(), 1U << 20U);
            Numbers random(25);
            int empty = 0;
            int shown = 0;
            for (int i = 0; i < 60; ++i) {
                Tile tile;
                bool said_empty = false;
                while (tile.level < shape.tree.max_level) {
                    const glm::uvec2 mask = content.oracle().child_mask(tile);
                    // Every second path goes down where something may be.
                    const auto may_show = [&mask](int c) { return (mask[c / 32] >> (c % 32) & 1U) != 0; };
                    int child = int(random.between(0, shape.tree.child_count() - 1));
                    for (int turn = 0; i % 2 == 0 && !may_show(child) && turn < 1000; ++turn)
                        child = int(random.between(0, shape.tree.child_count() - 1));
                    said_empty = said_empty || !may_show(child);
                    tile = child_of(tile, n, child);
                    const bool shown_here = shows(tile, content, pool);
                    ASSERT_FALSE(said_empty && shown_here)
                        << named.name << ", n " << n << ", seed 25, level " << tile.level << ", turn " << i;
                    empty += said_empty ? 1 : 0;
                    shown += shown_here ? 1 : 0;
                }
            }
            EXPECT_GT(empty, 5) << named.name;
            EXPECT_GT(shown, 5) << named.name;
        }
    }
}

TEST_F(VolumeBricks, OfOneValueAreCalledConstantAndHaveTheirMean) {
    const auto ball = std::make_shared<HollowSphere>(2, 128, 0.0, 0.5);
    const VolumeShape shape = make_volume_shape(ball->frame(), 2, 8, 128);
    VolumeContent content(shape, ball, visible_from(1));
    BrickPool pool(shape.tree, content.channels(), 1U << 20U);
    const BrickRequest requests[] = {{{shape.tree.max_level, {8, 8, 8}}, 0},   // within
                                     {{shape.tree.max_level, {0, 0, 0}}, 1},   // outside
                                     {{shape.tree.max_level, {8, 8, 0}}, 2}};  // across its surface
    const std::vector<ProducedTile> produced = content.producer().produce(requests, pool);
    ASSERT_EQ(produced.size(), 3U);
    EXPECT_TRUE(produced[0].constant);
    EXPECT_EQ(produced[0].mean.x, 255);
    EXPECT_TRUE(produced[1].constant);
    EXPECT_EQ(produced[1].mean.x, 0);
    EXPECT_FALSE(produced[2].constant);
    EXPECT_GT(produced[2].mean.x, 0);
    EXPECT_LT(produced[2].mean.x, 255);
}

TEST_F(VolumeBricks, HaveOneByteAVoxelAndNoNormals) {
    const TreeShape shape = make_tree_shape(4, 16, 256);
    BrickPool pool(shape, Channels{.color = false, .normal = false}, 10U << 20U);
    const std::size_t slot = 18 * 18 * 18 + 8 * pool.mask_words();
    EXPECT_EQ(pool.mask_words(), 65U);
    EXPECT_EQ(pool.size_bytes(), slot * std::size_t(pool.slot_count()));
    EXPECT_GE(pool.slot_count(), int((10U << 20U) / slot * 9 / 10));
}

}  // namespace
}  // namespace cairn::renderer

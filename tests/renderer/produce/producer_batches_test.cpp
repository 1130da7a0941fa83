// How many bricks, triangles and pairs are produced at a time changes no byte of a brick. The numbers are set
// so small that a few bricks take many batches.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "renderer/pool/brick_pool.h"
#include "renderer/produce/fractal_content.h"
#include "renderer/produce/made_fields.h"
#include "renderer/produce/surface_producer.h"
#include "renderer/produce/tile_lists.h"
#include "renderer/produce/volume_content.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mixed_scene.h"
#include "tests/support/produced_brick.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

class ProducerBatches : public GlTest {};

/// A tile's 8 children and grandchildren of one child, each with a slot.
std::vector<BrickRequest> some_requests(const TreeShape& shape) {
    std::vector<BrickRequest> requests = {{{0, glm::i64vec3(0)}, 0}};
    for (const std::int64_t level : {1, 2}) {
        for (int child = 0; child < 8; ++child) {
            const glm::i64vec3 place = glm::i64vec3(child % 2, child / 2 % 2, child / 4) + (level - 1);
            if (level <= shape.max_level) requests.push_back({{int(level), place}, int(requests.size())});
        }
    }
    return requests;
}

/// All bytes of the slots, as a producer left them in a pool of its own.
std::vector<std::vector<std::uint8_t>> bricks_of(Producer& producer, const TreeShape& shape,
                                                 Channels channels) {
    const std::vector<BrickRequest> requests = some_requests(shape);
    BrickPool pool(shape, channels, requests.size() * 2 * slot_bytes(shape.m, true));
    (void)producer.produce(requests, pool);
    std::vector<std::vector<std::uint8_t>> bricks;
    for (const BrickRequest& request : requests)
        bricks.push_back(slot_content(pool, request.slot));
    return bricks;
}

TEST_F(ProducerBatches, OfAnySizeGiveTheSameBricksOfASurface) {
    const TreeShape shape = make_tree_shape(2, 8, 64);
    const scenes::Scene scene = mixed_scene(401);
    const voxelizer::Grid grid{glm::dvec3(0.0), 1.0 / 64, glm::ivec3(64)};
    const auto produced = [&](std::uint32_t chunk_triangles, const SurfaceProducerLimits& limits) {
        const voxelizer::Surface surface =
            voxelizer::build_surface(scene, scenes::take_snapshot(scene), grid,
                                     {.attributes = true, .chunk_triangles = chunk_triangles});
        const voxelizer::GpuSurface uploaded = upload(surface);
        voxelizer::TriangleIndex lists = tile_lists(shape, surface);
        SurfaceProducer producer(shape, uploaded, lists, {}, limits);
        return bricks_of(producer, shape, {.color = surface.has_color, .packed = true});
    };
    const auto truth = produced(voxelizer::surface_chunk_triangles, {});
    ASSERT_EQ(truth.size(), 17U);
    for (const std::uint32_t number : {0U, 2U, 3U, 64U}) {
        EXPECT_TRUE(produced(voxelizer::surface_chunk_triangles, {.scratch_bytes = 0, .pairs = number}) ==
                    truth)
            << number << " pairs at a time";
        EXPECT_TRUE(produced(std::max(number, 1U), {.scratch_bytes = 100'000 * number, .pairs = 64}) == truth)
            << "chunks of " << number;
    }
}

TEST_F(ProducerBatches, OfAnySizeGiveTheSameBricksOfAVolume) {
    const auto ball = std::make_shared<HollowSphere>(2, 64, 0.2, 0.45);
    const VolumeShape shape = make_volume_shape(ball->frame(), 2, 8, 64);
    const DensityTest test(
        TransferFunction({{0.0, glm::dvec3(1.0), 0.0}, {1.0, glm::dvec3(1.0), 1.0}}).visible());
    const auto produced = [&](std::size_t batch_bytes) {
        VolumeProducer producer(shape, *ball, test, batch_bytes);
        return bricks_of(producer, shape.tree, {.color = false, .normal = false});
    };
    const auto truth = produced(std::size_t(4) << 20U);
    ASSERT_EQ(truth.size(), 17U);
    for (const std::size_t bytes : {0, 2000, 3000, 12000})
        EXPECT_TRUE(produced(bytes) == truth) << bytes << " bytes at a time";
}

TEST_F(ProducerBatches, OfAnySizeGiveTheSameBricksOfAFractal) {
    const TreeShape shape = make_tree_shape(2, 8, 64);
    const auto produced = [&](std::size_t batch) {
        FractalProducer producer(shape, {}, batch);
        return bricks_of(producer, shape, {.color = false});
    };
    const auto truth = produced(1024);
    for (const std::size_t batch : {0, 1, 2, 3, 16})
        EXPECT_TRUE(produced(batch) == truth) << batch << " bricks at a time";
}

}  // namespace
}  // namespace cairn::renderer

// Surfaces of many batches and chunks: how much is done at a time may change no voxel and no attribute. The
// sizes are set so small that a small scene takes many batches.
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/mixed_scene.h"
#include "voxelizer/methods/voxel_attributes.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/surface/moving_surface.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr int side = 32;
constexpr Region region{5, glm::ivec3(0), glm::ivec3(side)};

Surface surface_of(const scenes::Scene& scene, std::uint32_t chunk_triangles) {
    const Grid grid{glm::dvec3(0.0), 1.0 / side, glm::ivec3(side)};
    return build_surface(scene, scenes::take_snapshot(scene), grid,
                         {.attributes = true, .chunk_triangles = chunk_triangles});
}

BatchLimits all_limits(std::uint32_t number) {
    return {.triangles = number,
            .candidates = number,
            .pairs = number,
            .part_voxels = 50 * number,  // else thousands of parts
            .threads = number,
            .target_bytes = number};
}

std::string to_string(std::uint32_t limit, std::uint32_t chunk) {
    return fmt::format("{} at a time, chunks of {}", limit, chunk);
}

struct Sizes {
    std::uint32_t limit, chunk;
};
constexpr std::array<Sizes, 5> small_sizes = {
    {{2, 64}, {3, 3}, {64, 2}, {64, surface_chunk_triangles}, {1, 7}}};

class Batches : public GlTest {};

TEST_F(Batches, OfAnySizeMarkTheExactVoxels) {
    const scenes::Scene scene = mixed_scene(301);
    const BitGrid truth = reference::exact_voxels(surface_of(scene, surface_chunk_triangles), region);
    ASSERT_GT(truth.count(), 2000U);
    for (const auto& [limit, chunk] : small_sizes) {
        const GpuSurface surface = upload(surface_of(scene, chunk));
        const auto voxelizer = make_voxelizer(Method::conservative, {}, all_limits(limit));
        EXPECT_TRUE(same_bits(voxelizer->voxelize(surface, region), truth)) << to_string(limit, chunk);
    }
}

/// Each subset alone, because a subset is bound beside buffers that other passes bind too.
TEST_F(Batches, OfAnySizeMarkTheSameVoxelsOfASubsetByEveryMethod) {
    const scenes::Scene scene = mixed_scene(302);
    const GpuSurface whole = upload(surface_of(scene, surface_chunk_triangles));
    std::vector<std::uint32_t> all(120);
    std::vector<std::uint32_t> some;
    for (std::uint32_t i = 0; i < 120; ++i) {
        all[i] = i;
        if (i % 3 != 1) some.push_back(i);
    }
    for (const Method method : methods()) {
        const auto at_once = make_voxelizer(method);
        for (const std::vector<std::uint32_t>& subset : {all, some}) {
            const BitGrid truth = at_once->voxelize(whole, region, subset);
            ASSERT_GT(truth.count(), 500U) << name_of(method);
            for (const auto& [limit, chunk] : small_sizes) {
                const GpuSurface surface = upload(surface_of(scene, chunk));
                const auto voxelizer = make_voxelizer(method, {}, all_limits(limit));
                EXPECT_TRUE(same_bits(voxelizer->voxelize(surface, region, subset), truth))
                    << name_of(method) << ", " << subset.size() << " triangles, " << to_string(limit, chunk);
            }
        }
        EXPECT_TRUE(same_bits(at_once->voxelize(whole, region, all), at_once->voxelize(whole, region)))
            << name_of(method);
    }
}

TEST_F(Batches, OfAnySizeGiveTheSameAttributes) {
    const scenes::Scene scene = mixed_scene(303);
    const GpuSurface whole = upload(surface_of(scene, surface_chunk_triangles));
    const BitGrid bits = make_voxelizer(Method::conservative)->voxelize(whole, region);
    const VoxelAttributes truth = AttributeVoxelizer().gather(whole, region, bits);
    std::vector<std::uint32_t> all(120);
    for (std::uint32_t i = 0; i < 120; ++i)
        all[i] = i;
    for (const auto& [limit, chunk] : small_sizes) {
        const GpuSurface surface = upload(surface_of(scene, chunk));
        AttributeVoxelizer gatherer({}, all_limits(limit));
        for (const bool by_subset : {false, true}) {
            const VoxelAttributes ours = by_subset ? gatherer.gather(surface, region, bits, all)
                                                   : gatherer.gather(surface, region, bits);
            EXPECT_TRUE(ours.colors == truth.colors) << to_string(limit, chunk);
            EXPECT_TRUE(ours.normals == truth.normals) << to_string(limit, chunk);
        }
    }
}

TEST_F(Batches, ChunksOfAnySizeMoveAlike) {
    scenes::Scene scene = mixed_scene(304);
    scenes::Animation& animation = scene.animations.emplace_back();
    animation.duration = 1.0;
    animation.channels.push_back({.node = 0, .times = {0.0F, 1.0F}, .values = {0, 0, 0, 0.2F, 0.3F, 0.1F}});
    const Grid grid{glm::dvec3(0.0), 1.5 / side, glm::ivec3(side)};
    const scenes::When start{0.0, 0, std::nullopt};
    const scenes::When later{0.7, 0, std::nullopt};
    const BitGrid truth = reference::exact_voxels(
        build_surface(scene, scenes::take_snapshot(scene, later), grid), voxelizer::whole(grid));
    for (const std::uint32_t chunk : {2U, 3U, 64U}) {
        MovingSurface moving(scene, start, grid, {.chunk_triangles = chunk});
        const auto voxelizer = make_voxelizer(Method::conservative, {}, all_limits(3));
        EXPECT_TRUE(
            same_bits(voxelizer->voxelize(moving.move_to(later.seconds), voxelizer::whole(grid)), truth))
            << "chunks of " << chunk;
    }
}

}  // namespace
}  // namespace cairn::voxelizer

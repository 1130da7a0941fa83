#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "scenes/snapshot.h"
#include "shaders/interop/surface.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/moving_surface.h"

namespace cairn::test {

inline scenes::When moment(double seconds, int animation) {
    return {seconds, animation, std::nullopt};
}

/// The greatest difference of two packed normals, in steps of their coordinates.
inline int steps_between(std::uint32_t a, std::uint32_t b) {
    const auto part = [](std::uint32_t packed, int shift) {
        return int(std::int16_t(std::uint16_t(packed >> shift)));
    };
    return std::max(std::abs(part(a, 0) - part(b, 0)), std::abs(part(a, 16) - part(b, 16)));
}

template <typename T>
std::vector<T> all_of(const gl::Buffer& buffer, std::size_t count) {
    return buffer.read_all<T>(count);
}

/// Passes if the vertices are those of the snapshot's surface, bit for bit, and the normals up to one step.
inline ::testing::AssertionResult same_vertices(const voxelizer::GpuSurface& ours,
                                                const voxelizer::Surface& truth) {
    if (ours.chunks.size() != truth.chunks.size()) return ::testing::AssertionFailure() << "chunks differ";
    for (std::size_t c = 0; c < truth.chunks.size(); ++c) {
        const voxelizer::SurfaceChunk& chunk = truth.chunks[c];
        if (ours.chunks[c].triangle_count != chunk.triangles.size())
            return ::testing::AssertionFailure()
                   << ours.chunks[c].triangle_count << " triangles, not " << chunk.triangles.size();
        const auto positions =
            all_of<std::array<std::int32_t, 3>>(ours.chunks[c].positions, chunk.positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const auto& p = positions[i];
            const auto& q = chunk.positions[i];
            if (p != q)
                return ::testing::AssertionFailure() << fmt::format("vertex {}: ({} {} {}), not ({} {} {})",
                                                                    i, p[0], p[1], p[2], q[0], q[1], q[2]);
        }
        const auto attributes =
            all_of<interop::SurfaceAttributes>(ours.chunks[c].attributes, chunk.attributes.size());
        for (std::size_t i = 0; i < attributes.size(); ++i) {
            if (steps_between(attributes[i].normal, chunk.attributes[i].normal) > 1 ||
                (attributes[i].normal == 0) != (chunk.attributes[i].normal == 0) ||
                attributes[i].red_green != chunk.attributes[i].red_green ||
                attributes[i].blue_alpha != chunk.attributes[i].blue_alpha ||
                attributes[i].u != chunk.attributes[i].u || attributes[i].v != chunk.attributes[i].v)
                return ::testing::AssertionFailure()
                       << fmt::format("attributes of vertex {}: normal {:08x}, not {:08x}", i,
                                      attributes[i].normal, chunk.attributes[i].normal);
        }
    }
    return ::testing::AssertionSuccess();
}

class Moving : public GlTest {
protected:
    /// Moves a surface through `times` in a grid around all of them, and compares each frame.
    void expect_the_snapshots(const scenes::Scene& scene, const scenes::When& when,
                              const std::vector<double>& times, int resolution) {
        const voxelizer::Grid grid =
            voxelizer::grid_around(scenes::bounds_over_animation(scene, when, 8.0), resolution);
        voxelizer::MovingSurface moving(scene, when, grid, {.attributes = true});
        voxelizer::BitGrid bits;
        for (const double seconds : times) {
            const std::string where =
                fmt::format("{} animation {} at {} s", scene.name, when.animation.value_or(-1), seconds);
            const scenes::Snapshot snapshot =
                scenes::take_snapshot(scene, {seconds, when.animation, when.scene_index});
            const voxelizer::Surface truth =
                voxelizer::build_surface(scene, snapshot, grid, {.attributes = true});
            const voxelizer::GpuSurface& ours = moving.move_to(seconds);
            EXPECT_FALSE(moving.was_on_cpu()) << where;
            // If every triangle reaches the cube, as here at most moments, the two lists are the same.
            if (truth.triangle_count == moving.triangle_count()) {
                EXPECT_TRUE(same_vertices(ours, truth)) << where;
                ++vertices_compared_;
            }
            marker().voxelize_into(ours, voxelizer::whole(grid), bits);
            const voxelizer::BitGrid exact = reference::exact_voxels(truth, voxelizer::whole(grid));
            EXPECT_TRUE(same_bits(bits, exact)) << where;
            EXPECT_GT(exact.count(), 0U) << where;
        }
    }

    voxelizer::Voxelizer& marker() {
        if (!voxelizer_) voxelizer_ = std::make_unique<voxelizer::ConservativeVoxelizer>();
        return *voxelizer_;
    }
    void TearDown() override {
        voxelizer_.reset();
        GlTest::TearDown();
    }
    int vertices_compared_ = 0;

private:
    std::unique_ptr<voxelizer::Voxelizer> voxelizer_;
};

}  // namespace cairn::test

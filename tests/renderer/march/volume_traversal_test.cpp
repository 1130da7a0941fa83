// All traversals of the tree show the same picture of a volume. A volume has tiles that are not empty while
// all their children are, because a coarse tile takes in densities up to a coarse voxel outside.
#include <random>

#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::Traversal;

scenes::Volume dots(int side, int count, unsigned seed) {
    scenes::Volume volume = blobs(glm::ivec3(side), seed, 0);
    std::mt19937 rng(seed);
    for (int i = 0; i < count; ++i)
        volume.samples[rng() % volume.samples.size()] = 65535;
    return volume;
}

class VolumeTraversal : public GlTest {};

TEST_F(VolumeTraversal, TilesWithoutFullChildrenHideNothingBehindThem) {
    const scenes::Volume volume = dots(128, 10, 4);
    renderer::View view = glowing_view(volume.bounds(), 64, 64);
    view.detail.pixel_error = 0.25;
    for (const int n : {2, 4}) {
        for (const bool block_starts : {false, true}) {
            optics::Image expected;
            for (const Traversal traversal :
                 {Traversal::restart, Traversal::stackless, Traversal::mini_stack}) {
                Settings options{.tree = {.n = n, .m = 8}, .pools = {.brick_bytes = 8U << 20U}};
                options.march.traversal = traversal;
                options.march.block_starts = block_starts;
                Renderer renderer = voxel_renderer(volume, ramp(400.0, 0.01), options);
                const optics::Image first = renderer.render(view).image;
                if (expected.rgba.empty()) expected = first;
                EXPECT_EQ(first.rgba, expected.rgba) << "n " << n << ", traversal " << int(traversal);
                renderer.forget_picture();
                EXPECT_EQ(renderer.render(view).image.rgba, expected.rgba)
                    << "n " << n << ", traversal " << int(traversal) << ", a second time";
            }
        }
    }
}

}  // namespace
}  // namespace cairn::test

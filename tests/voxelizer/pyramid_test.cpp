// Pyramids of both kinds: the GPU's, the CPU's, and the definition.
#include <gtest/gtest.h>

#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/pyramid_builder.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

const std::vector<glm::ivec3> sizes = {{1, 1, 1},  {1, 1, 9},   {2, 1, 5},    {3, 3, 3},    {31, 32, 33},
                                       {33, 7, 1}, {64, 64, 2}, {65, 129, 6}, {100, 3, 40}, {1, 70, 1}};

BitGrid random_grid(const glm::ivec3& size, std::uint32_t seed, int one_in) {
    Random random(seed);
    BitGrid bits(size);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                if (random.between(1, one_in) == 1) bits.set({x, y, z});
    return bits;
}

/// A level straight from the finest one: a voxel of level i covers 2^i voxels along each axis that is
/// reduced.
BitGrid defined_level(const BitGrid& finest, int level, Reduction reduction) {
    const glm::ivec3 shift(level, level, reduction == Reduction::xyz ? level : 0);
    BitGrid out((finest.size + (glm::ivec3(1) << shift) - 1) >> shift);
    for (int z = 0; z < finest.size.z; ++z)
        for (int y = 0; y < finest.size.y; ++y)
            for (int x = 0; x < finest.size.x; ++x)
                if (finest.at({x, y, z})) out.set(glm::ivec3(x, y, z) >> shift);
    return out;
}

void expect_defined(const BitmaskPyramid& pyramid, const BitGrid& finest, Reduction reduction,
                    const std::string& what) {
    for (int level = 0; level < pyramid.level_count(); ++level) {
        const BitGrid expected = defined_level(finest, level, reduction);
        ASSERT_EQ(pyramid.level(level).size, expected.size) << what << ", level " << level;
        EXPECT_TRUE(same_bits(pyramid.level(level), expected)) << what << ", level " << level;
    }
    const glm::ivec3 top = pyramid.level(pyramid.level_count() - 1).size;
    EXPECT_EQ(top, reduction == Reduction::xyz ? glm::ivec3(1) : glm::ivec3(1, 1, finest.size.z)) << what;
}

class PyramidTest : public GlTest {};

TEST_F(PyramidTest, BothKindsAreAsDefinedOnTheCpuAndOnTheGpu) {
    PyramidBuilder builder{gl::ShaderSource()};
    for (const Reduction reduction : {Reduction::xyz, Reduction::xy}) {
        for (const glm::ivec3& size : sizes) {
            for (const int one_in : {2, 200}) {
                const BitGrid finest = random_grid(size, 71, one_in);
                const std::string what = fmt::format(
                    "{} {} {}, {}", size.x, size.y, size.z,
                    reduction == Reduction::xy ? "halved along x and y" : "halved along all axes");
                expect_defined(build_pyramid(finest, reduction), finest, reduction, "CPU, " + what);
                const gl::Buffer bits =
                    gl::Buffer::of(std::span<const std::uint32_t>(finest.words), "finest level");
                expect_defined(builder.build(bits, size, reduction), finest, reduction, "GPU, " + what);
            }
        }
    }
}

TEST_F(PyramidTest, VoxelizersBuildTheKindThatIsAskedFor) {
    Random random(72);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 20; ++i)
        triangles.push_back(random_triangle(random, lattice_side / 64));
    const GpuSurface surface = upload(lattice_surface(triangles, 64));
    const Region region{6, {3, 0, 5}, {50, 41, 37}};
    ConservativeVoxelizer voxelizer;
    const BitGrid finest = voxelizer.voxelize(surface, region);
    for (const Reduction reduction : {Reduction::xyz, Reduction::xy}) {
        expect_defined(voxelizer.voxelize_pyramid(surface, region, std::nullopt, reduction), finest,
                       reduction, reduction == Reduction::xy ? "columns" : "octree");
    }
}

}  // namespace
}  // namespace cairn::voxelizer

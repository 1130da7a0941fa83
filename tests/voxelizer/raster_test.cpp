// The raster methods on hand-made primitives: bits in their places, tiles, masks, lines, points, state.
#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include <gtest/gtest.h>

#include "base/error.h"
#include "gl/handle.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/voxelize.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/methods/raster_tiles.h"
#include "voxelizer/methods/raster_voxelizer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::int64_t N = lattice_side;
constexpr std::array<Method, 3> methods = {Method::slice_map, Method::three_axis,
                                           Method::three_axis_conservative};

class RasterTest : public GlTest {
protected:
    void TearDown() override {
        voxelizers_.clear();
        GlTest::TearDown();
    }
    RasterVoxelizer& voxelizer(Method method) {
        return voxelizers_.try_emplace(method, method).first->second;
    }
    BitGrid voxelize(Method method, const std::vector<LatticeTriangle>& triangles, const Region& region) {
        return voxelizer(method).voxelize(upload(lattice_surface(triangles, 16)), region);
    }

private:
    std::map<Method, RasterVoxelizer> voxelizers_;
};

const Region sixteen{4, glm::ivec3(0), glm::ivec3(16)};
constexpr std::int64_t voxel = N / 16;  // lattice units per voxel of `sixteen`

/// Two triangles across the whole cube and more, in a plane of constant coordinate.
std::vector<LatticeTriangle> wall(int axis, std::int64_t at) {
    std::array<glm::i64vec3, 4> corners;
    for (int i = 0; i < 4; ++i) {
        glm::i64vec3& p = corners[std::size_t(i)];
        p[axis] = at;
        p[(axis + 1) % 3] = i % 2 == 0 ? -N : 2 * N;
        p[(axis + 2) % 3] = i / 2 == 0 ? -N : 2 * N;
    }
    return {{corners[0], corners[1], corners[2]}, {corners[1], corners[2], corners[3]}};
}

TEST_F(RasterTest, EveryMethodHasAName) {
    for (const Method method : methods) {
        EXPECT_EQ(method_named(name_of(method)), method);
        EXPECT_NE(make_voxelizer(method), nullptr);
    }
    EXPECT_EQ(name_of(Method::three_axis), "three-axis");
}

class RasterSlices : public RasterTest, public ::testing::WithParamInterface<int> {};

/// Walls in many slices, and the voxels that they fill: 2 x 2 per slice.
BitGrid walls_in_slices(int axis, const Region& region, std::vector<LatticeTriangle>& walls) {
    BitGrid expected(region.size);
    const std::int64_t side = region.voxel_side();
    const int size = region.size[axis];
    for (int slice = 0; slice < size; ++slice) {
        const bool at_an_edge = slice % 32 == 0 || slice % 32 == 31 || slice == size - 1;
        if (!at_an_edge && slice % 7 != 0) continue;
        for (const LatticeTriangle& t : wall(axis, slice * side + side / 2))
            walls.push_back(t);
        for (int i = 0; i < 4; ++i) {
            glm::ivec3 v;
            v[axis] = slice;
            v[(axis + 1) % 3] = i % 2;
            v[(axis + 2) % 3] = i / 2;
            expected.set(v);
        }
    }
    return expected;
}

TEST_P(RasterSlices, AreInTheirWordsAndBits) {
    const int level = int(std::bit_width(unsigned(GetParam() - 1)));
    for (int axis = 0; axis < 3; ++axis) {
        Region region{level, glm::ivec3(0), glm::ivec3(2)};
        region.size[axis] = GetParam();
        std::vector<LatticeTriangle> walls;
        const BitGrid expected = walls_in_slices(axis, region, walls);
        for (const Method method : methods) {
            const bool sees = axis == 2 || method != Method::slice_map;
            EXPECT_TRUE(same_bits(voxelize(method, walls, region), sees ? expected : BitGrid(region.size)))
                << name_of(method) << ", along axis " << axis;
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Sizes, RasterSlices, ::testing::Values(1, 31, 32, 33, 127, 128, 129, 200, 1025));

TEST_F(RasterTest, WallsParallelToZVanishInASliceMapAlone) {
    for (const int axis : {0, 1, 2}) {
        const std::vector<LatticeTriangle> walls = wall(axis, 5 * voxel + 77);
        const BitGrid truth = reference::exact_voxels(lattice_surface(walls, 16), sixteen);
        EXPECT_EQ(voxelize(Method::slice_map, walls, sixteen).count(), axis == 2 ? 256U : 0U);
        EXPECT_TRUE(same_bits(voxelize(Method::three_axis, walls, sixteen), truth)) << "axis " << axis;
        EXPECT_TRUE(same_bits(voxelize(Method::three_axis_conservative, walls, sixteen), truth));
    }
}

TEST_F(RasterTest, FacesInTheEndsOfARegionCount) {
    for (const Region& region : {sixteen, Region{4, glm::ivec3(3), glm::ivec3(10)}}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int end : {0, 1}) {
                const int plane = end == 0 ? region.origin[axis] : region.origin[axis] + region.size[axis];
                const BitGrid bits = voxelize(Method::three_axis, wall(axis, plane * voxel), region);
                EXPECT_EQ(int(bits.count()), region.size.x * region.size.x) << "axis " << axis << ", " << end;
                glm::ivec3 place(1);
                place[axis] = end == 0 ? 0 : region.size[axis] - 1;
                EXPECT_TRUE(bits.at(place)) << "axis " << axis << ", end " << end;
            }
        }
    }
}

TEST_F(RasterTest, EnlargedTrianglesOfAllKindsMissNothing) {
    Random random(51);
    for (const Region& region :
         {Region{0, glm::ivec3(-1), glm::ivec3(3)}, Region{3, glm::ivec3(-1), glm::ivec3(10)}, sixteen,
          Region{5, {3, -2, 11}, {29, 17, 13}}, Region{9, {250, 240, 260}, {33, 12, 9}},
          Region{14, {8100, 8190, 8200}, {40, 16, 33}}, Region{20, glm::ivec3(1 << 19), glm::ivec3(16)},
          Region{24, glm::ivec3(1 << 23), glm::ivec3(12)}}) {
        std::uint64_t extra = 0;
        std::uint64_t occupied = 0;
        for (int i = 0; i < 150; ++i) {
            LatticeTriangle t = random_triangle(random, region.voxel_side());
            if (i % 3 == 0) {  // through the region, however deep it lies
                const glm::i64vec3 middle = glm::i64vec3(region.origin * 2 + region.size) *
                                            std::int64_t(region.voxel_side()) / std::int64_t(2);
                t[2] =
                    glm::clamp(middle * std::int64_t(3) - t[0] - t[1], glm::i64vec3(-N), glm::i64vec3(2 * N));
            }
            if (!std::all_of(t.begin(), t.end(), within_shader_range)) continue;
            const BitGrid bits = voxelize(Method::three_axis_conservative, {t}, region);
            const reference::Comparison c = reference::compare(bits, voxels_of(t, region));
            EXPECT_EQ(c.missing, 0U) << to_string(t) << "level " << region.level;
            extra += c.extra;
            occupied += c.occupied;
        }
        EXPECT_LT(extra, occupied) << "level " << region.level;
    }
}

TEST_F(RasterTest, ThinMethodsMarkWhatTheTriangleTouches) {
    // Also at deep levels, where corners lie a million voxels away.
    Random random(52);
    for (const int level : {4, 8, 14, 18}) {
        const glm::i64vec3 middle(N / 2 + 12345);
        const Region region{level, glm::ivec3(middle >> std::int64_t(LATTICE_BITS - level)) - 8,
                            glm::ivec3(16)};
        std::uint64_t marked = 0;
        std::uint64_t extra = 0;
        for (int i = 0; i < 60; ++i) {
            const glm::i64vec3 a = random.point(0, N);
            const glm::i64vec3 b = random.point(0, N);
            const LatticeTriangle t = {a, b, middle * std::int64_t(3) - a - b};
            if (!within_shader_range(t[2])) continue;
            const BitGrid bits = voxelize(Method::three_axis, {t}, region);
            marked += bits.count();
            extra += reference::compare(bits, voxels_of(t, region)).extra;
        }
        EXPECT_GT(marked, 1000U) << "level " << level;
        EXPECT_LE(extra, marked / 1000) << "level " << level;
    }
}

TEST_F(RasterTest, PartsOfARegionHaveTheBitsOfTheWholeButForRounding) {
    // Voxels within a float's rounding, or OpenGL's snapping, of a boundary may fall to either side.
    Random random(53);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 60; ++i)
        triangles.push_back({random.point(0, N), random.point(0, N), random.point(0, N)});
    const GpuSurface surface = upload(lattice_surface(triangles, 64));
    const Region all{6, glm::ivec3(-2), glm::ivec3(68)};
    for (const Method method : methods) {
        const BitGrid whole_bits = voxelizer(method).voxelize(surface, all);
        for (const glm::ivec3& step : {glm::ivec3(34), glm::ivec3(7, 33, 68)}) {
            BitGrid assembled(all.size);
            for (int z = 0; z < 68; z += step.z) {
                for (int y = 0; y < 68; y += step.y) {
                    for (int x = 0; x < 68; x += step.x) {
                        const glm::ivec3 low(x, y, z);
                        const Region part{6, all.origin + low, glm::min(step, 68 - low)};
                        const BitGrid bits = voxelizer(method).voxelize(surface, part);
                        for (int i = 0; i < part.size.x * part.size.y * part.size.z; ++i) {
                            const glm::ivec3 v(i % part.size.x, i / part.size.x % part.size.y,
                                               i / part.size.x / part.size.y);
                            if (bits.at(v)) assembled.set(low + v);
                        }
                    }
                }
            }
            const reference::Comparison c = reference::compare(assembled, whole_bits);
            EXPECT_LE(c.missing + c.extra, c.occupied / 2000) << name_of(method) << ", parts of " << step.x;
        }
    }
}

TEST_F(RasterTest, SubsetsAndChunksMarkOnlyTheirTriangles) {
    std::vector<LatticeTriangle> triangles;
    for (int slice = 0; slice < 16; ++slice) {
        const std::int64_t z = slice * voxel + 99;
        triangles.push_back({glm::i64vec3(0, 0, z), glm::i64vec3(N, 0, z), glm::i64vec3(0, N, z)});
    }
    Surface surface = lattice_surface(triangles, 16);
    const SurfaceChunk first = surface.chunks[0];
    surface.chunks.push_back(lattice_surface({{wall(0, 3 * voxel + 9)[0]}}, 16).chunks[0]);
    const GpuSurface on_gpu = upload(surface);
    const std::vector<std::uint32_t> chosen = {2, 5, 11, surface_chunk_triangles};
    for (const Method method : methods) {
        const std::vector<LatticeTriangle> same = {triangles[2], triangles[5], triangles[11],
                                                   wall(0, 3 * voxel + 9)[0]};
        EXPECT_TRUE(
            same_bits(voxelizer(method).voxelize(on_gpu, sixteen, chosen), voxelize(method, same, sixteen)))
            << name_of(method);
        EXPECT_EQ(voxelizer(method).voxelize(on_gpu, sixteen, std::span<const std::uint32_t>()).count(), 0U);
    }
    EXPECT_EQ(first.triangles.size(), 16U);
}

TEST_F(RasterTest, PointsMarkTheVoxelThatHoldsThem) {
    Random random(54);
    std::vector<LatticeTriangle> points;
    BitGrid expected(sixteen.size);
    for (int i = 0; i < 40; ++i) {
        const glm::i64vec3 v = random.point(0, 15);
        const glm::i64vec3 p = v * voxel + random.point(voxel / 8, voxel * 7 / 8);
        points.push_back({p, p, p});
        expected.set(glm::ivec3(v));
    }
    for (const Method method : methods)
        EXPECT_TRUE(same_bits(voxelize(method, points, sixteen), expected)) << name_of(method);
}

TEST_F(RasterTest, SegmentsAreLinesWithoutGaps) {
    Random random(55);
    for (int i = 0; i < 60; ++i) {
        const LatticeTriangle t = {random.point(0, N - 1), random.point(0, N - 1), {}};
        const LatticeTriangle segment = {t[0], t[1], t[1]};
        const BitGrid truth = voxels_of(segment, sixteen);
        const BitGrid thin = voxelize(Method::three_axis, {segment}, sixteen);
        const glm::i64vec3 d = glm::abs(t[1] - t[0]);
        const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
        // A voxel at each step along its length; OpenGL leaves out the pixel that a line ends in.
        const int from = int(std::min(t[0][axis], t[1][axis]) / voxel) + 1;
        const int to = int(std::max(t[0][axis], t[1][axis]) / voxel) - 1;
        for (int step = from; step <= to; ++step) {
            bool any = false;
            for (int j = 0; j < 256; ++j) {
                glm::ivec3 v;
                v[axis] = step;
                v[(axis + 1) % 3] = j % 16;
                v[(axis + 2) % 3] = j / 16;
                any = any || thin.at(v);
            }
            EXPECT_TRUE(any) << to_string(segment) << ", step " << step;
        }
        // OpenGL's lines may stray from the segment by part of a pixel.
        EXPECT_LE(reference::compare(thin, truth).extra, thin.count() / 4 + 1) << to_string(segment);
        const reference::Comparison c =
            reference::compare(voxelize(Method::three_axis_conservative, {segment}, sixteen), truth);
        EXPECT_EQ(c.missing, 0U) << to_string(segment);
    }
}

TEST_F(RasterTest, SegmentsAlongZVanishInASliceMapAlone) {
    const glm::i64vec3 a(3 * voxel + 9999, 4 * voxel + 5555, voxel + 1111);
    const LatticeTriangle segment = {a, a + glm::i64vec3(0, 0, 9 * voxel), a + glm::i64vec3(0, 0, 9 * voxel)};
    EXPECT_EQ(voxelize(Method::slice_map, {segment}, sixteen).count(), 0U);
    EXPECT_GE(voxelize(Method::three_axis, {segment}, sixteen).count(), 9U);
    EXPECT_EQ(voxelize(Method::three_axis_conservative, {segment}, sixteen), voxels_of(segment, sixteen));
}

TEST_F(RasterTest, FarTrianglesAreDrawnToo) {
    Random random(56);
    std::uint64_t marked = 0;
    for (int i = 0; i < 40; ++i) {
        const std::int64_t reach = (std::int64_t(1) << 38) >> (i % 12);
        LatticeTriangle t = {random.point(-reach, reach), random.point(-reach, reach), {}};
        t[2] = -t[0] - t[1] + random.point(0, N);
        if (i % 7 == 0) t[2] = t[1];
        const BitGrid truth = voxels_of(t, sixteen);
        const BitGrid thin = voxelize(Method::three_axis, {t}, sixteen);
        const BitGrid enlarged = voxelize(Method::three_axis_conservative, {t}, sixteen);
        marked += thin.count();
        EXPECT_LE(reference::compare(thin, truth).extra, truth.count() / 50 + 1) << to_string(t);
        EXPECT_EQ(reference::compare(enlarged, truth).missing, 0U) << to_string(t);
    }
    EXPECT_GT(marked, 1000U);
}

TEST_F(RasterTest, BothWaysToALayerGiveTheSameBits) {
    if (!RasterVoxelizer::has_vertex_path()) GTEST_SKIP() << "the driver has one way only";
    Random random(57);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 200; ++i)
        triangles.push_back(random_triangle(random, N / 64));
    triangles.push_back({glm::i64vec3(0), glm::i64vec3(3 * N), glm::i64vec3(0, 4 * N, 0)});
    const GpuSurface surface = upload(lattice_surface(triangles, 64));
    for (const Region& region :
         {Region{6, glm::ivec3(-3), {70, 67, 50}}, Region{6, glm::ivec3(2), {30, 37, 50}},
          Region{18, glm::ivec3(1 << 17), glm::ivec3(20)}}) {
        for (const Method method : methods) {
            RasterVoxelizer by_vertex(method, {}, LayerPath::vertex_shader);
            EXPECT_TRUE(
                same_bits(by_vertex.voxelize(surface, region), voxelizer(method).voxelize(surface, region)))
                << name_of(method) << ", level " << region.level;
        }
    }
}

TEST_F(RasterTest, DrawingStateOfOthersNeitherHarmsNorIsHarmed) {
    const std::vector<LatticeTriangle> walls = wall(2, 5 * voxel + 77);
    const BitGrid expected = voxelize(Method::three_axis, walls, sixteen);
    EXPECT_EQ(expected.count(), 256U);
    const std::array<GLenum, 6> on = {GL_BLEND,        GL_CULL_FACE,          GL_DEPTH_TEST,
                                      GL_SCISSOR_TEST, GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP};
    for (const GLenum name : on)
        glEnable(name);
    glCullFace(GL_FRONT_AND_BACK);
    glScissor(0, 0, 1, 1);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    glLogicOp(GL_XOR);
    glViewport(3, 5, 7, 11);
    GLuint framebuffer = 0;
    glCreateFramebuffers(1, &framebuffer);
    const gl::FramebufferHandle owner(framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    EXPECT_TRUE(same_bits(voxelize(Method::three_axis, walls, sixteen), expected));
    for (const GLenum name : on)
        EXPECT_TRUE(glIsEnabled(name)) << name;
    GLint number = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &number);
    EXPECT_EQ(GLuint(number), framebuffer);
    glGetIntegerv(GL_LOGIC_OP_MODE, &number);
    EXPECT_EQ(number, GL_XOR);
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    EXPECT_EQ(viewport, (std::array<GLint, 4>{3, 5, 7, 11}));
    std::array<GLboolean, 4> mask{};
    glGetBooleanv(GL_COLOR_WRITEMASK, mask.data());
    EXPECT_EQ(mask, (std::array<GLboolean, 4>{GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE}));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
}

TEST(RasterTiles, CoverARegionOnceWithinTheLimits) {
    const std::size_t limit = BatchLimits().target_bytes;
    for (const int directions : {1, 3}) {
        for (const glm::ivec3& size : {glm::ivec3(1), glm::ivec3(1024), glm::ivec3(1025, 3, 3),
                                       glm::ivec3(3, 16384, 40), glm::ivec3(2048, 1000, 37)}) {
            const std::vector<RasterTile> tiles = raster_tiles({14, glm::ivec3(0), size}, directions, limit);
            std::int64_t voxels = 0;
            for (const RasterTile& tile : tiles) {
                EXPECT_EQ(tile.place.x % 32, 0);
                EXPECT_LE(tile.longest_side(), 1024);
                EXPECT_LE(SliceTargets::bytes(tile.plane(directions), directions, tile.slices(directions)),
                          limit);
                EXPECT_EQ(tile.lattice_low, tile.place << tile.voxel_shift);
                voxels += std::int64_t(tile.size.x) * tile.size.y * tile.size.z;
            }
            EXPECT_EQ(voxels, std::int64_t(size.x) * size.y * size.z)
                << fmt::format("{} {} {}", size.x, size.y, size.z);
        }
    }
    EXPECT_TRUE(raster_tiles({4, glm::ivec3(40), glm::ivec3(5)}, 3, limit).empty())
        << "no vertex reaches there";
    EXPECT_EQ(raster_tiles({0, glm::ivec3(-8000), glm::ivec3(16000)}, 3, limit).size(), 1U);
}

}  // namespace
}  // namespace cairn::voxelizer

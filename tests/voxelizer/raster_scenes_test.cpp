// The raster methods on whole scenes, against the exact reference: the voxels that each misses and adds.
#include <array>
#include <map>

#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/flood_search.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/methods/raster_voxelizer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

Surface surface_of(const std::string& scene_name, int resolution) {
    const scenes::Scene scene = scenes::load(scene_name);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    return build_surface(scene, snapshot, grid_around(snapshot.bounds, resolution));
}

/// Missing and extra voxels, in percent of the voxels of the truth.
struct Limits {
    double least_missing, most_missing, most_extra;
};

struct Known {
    const char* scene;
    int resolution;
    std::map<Method, Limits> limits;
};

void PrintTo(const Known& known, std::ostream* out) {
    *out << known.scene << " at " << known.resolution;
}

class RasterScene : public GlTest, public ::testing::WithParamInterface<Known> {};

TEST_P(RasterScene, MissesAndAddsWhatItsMethodIsKnownFor) {
    const Surface surface = surface_of(GetParam().scene, GetParam().resolution);
    const GpuSurface on_gpu = upload(surface);
    const Region region = whole(surface.grid);
    const BitGrid truth = reference::exact_voxels(surface, region);
    for (const auto& [method, limits] : GetParam().limits) {
        const BitGrid bits = RasterVoxelizer(method).voxelize(on_gpu, region);
        const reference::Comparison comparison = reference::compare(bits, truth);
        const double percent = 100.0 / double(comparison.occupied);
        const std::string what = fmt::format("{}: {} missing, {} extra of {}", name_of(method),
                                             comparison.missing, comparison.extra, comparison.occupied);
        EXPECT_GE(double(comparison.missing) * percent, limits.least_missing) << what;
        EXPECT_LE(double(comparison.missing) * percent, limits.most_missing) << what;
        EXPECT_LE(double(comparison.extra) * percent, limits.most_extra) << what;
    }
}

// Thin methods leave out about half of the voxels that a curved surface touches, and most of a needle's.
INSTANTIATE_TEST_SUITE_P(Builtin, RasterScene,
                         ::testing::Values(Known{"builtin:knot",
                                                 128,
                                                 {{Method::slice_map, {55, 65, 0.01}},
                                                  {Method::three_axis, {40, 48, 0.01}},
                                                  {Method::three_axis_conservative, {0, 0, 3}}}},
                                           Known{"builtin:knot",
                                                 100,
                                                 {{Method::slice_map, {55, 65, 0.01}},
                                                  {Method::three_axis, {40, 48, 0.01}},
                                                  {Method::three_axis_conservative, {0, 0, 3}}}},
                                           Known{"builtin:spheres",
                                                 96,
                                                 {{Method::slice_map, {60, 75, 0.01}},
                                                  {Method::three_axis, {38, 48, 0.01}},
                                                  {Method::three_axis_conservative, {0, 0, 5}}}},
                                           Known{"builtin:cornell",
                                                 65,
                                                 {{Method::slice_map, {40, 90, 0.01}},
                                                  {Method::three_axis, {1, 60, 0.01}},
                                                  {Method::three_axis_conservative, {0, 0, 0.1}}}},
                                           Known{"builtin:needles",
                                                 64,
                                                 {{Method::slice_map, {90, 100, 0.01}},
                                                  {Method::three_axis, {85, 100, 0.01}},
                                                  {Method::three_axis_conservative, {0, 0, 40}}}}));

/// Voxels inside a closed surface that a walk through the walls found by `method` reaches all the same.
std::uint64_t leaks(Method method, const Surface& surface, std::uint64_t& inside_count) {
    const Region region = whole(surface.grid);
    const BitGrid truth = reference::exact_voxels(surface, region);
    const BitGrid outside = searched(truth);
    const BitGrid reached = searched(RasterVoxelizer(method).voxelize(upload(surface), region));
    std::uint64_t leaked = 0;
    inside_count = 0;
    for (int z = 0; z < region.size.z; ++z) {
        for (int y = 0; y < region.size.y; ++y) {
            for (int x = 0; x < region.size.x; ++x) {
                const glm::ivec3 v(x, y, z);
                if (truth.at(v) || outside.at(v)) continue;
                ++inside_count;
                leaked += reached.at(v) ? 1 : 0;
            }
        }
    }
    return leaked;
}

// Fine enough for air between the spheres: pockets that two walls close are not inside either.
using SceneAt = std::pair<const char*, int>;
class ClosedSurface : public GlTest, public ::testing::WithParamInterface<SceneAt> {};

TEST_P(ClosedSurface, IsTightInThreeAxesAndHasHolesInASliceMap) {
    const Surface surface = surface_of(GetParam().first, GetParam().second);
    std::uint64_t inside = 0;
    EXPECT_EQ(leaks(Method::three_axis, surface, inside), 0U);
    EXPECT_GT(inside, 1000U);
    EXPECT_EQ(leaks(Method::three_axis_conservative, surface, inside), 0U);
    EXPECT_GT(leaks(Method::slice_map, surface, inside), inside / 2);
}
INSTANTIATE_TEST_SUITE_P(Builtin, ClosedSurface,
                         ::testing::Values(SceneAt("builtin:knot", 96), SceneAt("builtin:spheres", 192)));

/// The square x, y in [0, 1] at z = 0.55, in a grid over the unit cube, with an alpha texture of 4 x 4
/// texels.
Surface masked_sheet(const std::array<int, 16>& alphas, scenes::Wrap wrap, float repeats) {
    scenes::Scene scene;
    scenes::Image& image = scene.images.emplace_back();
    image.width = 4;
    image.height = 4;
    for (const int alpha : alphas)
        image.rgba.insert(image.rgba.end(), {255, 255, 255, std::uint8_t(alpha)});
    scene.textures.push_back({0, wrap, wrap});
    scenes::Material& material = scene.materials.emplace_back();
    material.texture = 0;
    material.alpha_mode = scenes::AlphaMode::mask;
    material.alpha_cutoff = 128.0F / 255.0F;
    scenes::Primitive primitive;
    primitive.material = 0;
    primitive.positions = {{0, 0, 0.55F}, {1, 0, 0.55F}, {1, 1, 0.55F}, {0, 1, 0.55F}};
    primitive.texcoords = {{0, 0}, {repeats, 0}, {repeats, repeats}, {0, repeats}};
    primitive.indices = {0, 1, 2, 0, 2, 3};
    scenes::Snapshot snapshot;
    snapshot.items.push_back({&primitive, primitive.positions, {}, glm::dmat4(1.0)});
    return build_surface(scene, snapshot, {glm::dvec3(0.0), 1.0 / 32, glm::ivec3(32)});
}

class RasterMasks : public GlTest, public ::testing::WithParamInterface<LayerPath> {};

TEST_P(RasterMasks, AreDecidedByTheTexelUnderThePixelsCentre) {
    if (GetParam() == LayerPath::vertex_shader && !RasterVoxelizer::has_vertex_path()) GTEST_SKIP();
    const std::array<int, 16> alphas = {255, 0, 0, 0, 0, 128, 0, 127, 0, 255, 0, 0, 0, 0, 200, 0};
    for (const scenes::Wrap wrap :
         {scenes::Wrap::repeat, scenes::Wrap::mirrored_repeat, scenes::Wrap::clamp_to_edge}) {
        const Surface surface = masked_sheet(alphas, wrap, 2.0F);  // a texel is 4 x 4 voxels
        BitGrid expected(glm::ivec3(32));
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                const auto texel = [&](int i) {
                    if (wrap == scenes::Wrap::repeat) return i / 4 % 4;
                    if (wrap == scenes::Wrap::mirrored_repeat) return i < 16 ? i / 4 : 7 - i / 4;
                    return std::min(i / 4, 3);
                };
                if (alphas[std::size_t(texel(y) * 4 + texel(x))] >= 128) expected.set({x, y, 17});
            }
        }
        for (const Method method : {Method::slice_map, Method::three_axis, Method::three_axis_conservative}) {
            RasterVoxelizer voxelizer(method, {}, GetParam());
            const BitGrid bits = voxelizer.voxelize(upload(surface), whole(surface.grid));
            const std::string what = fmt::format("{}, wrap {}", name_of(method), int(wrap));
            if (method != Method::three_axis_conservative) {
                EXPECT_TRUE(same_bits(bits, expected)) << what;
                continue;
            }
            // Along the diagonal a pixel's centre lies beside the triangle, and the nearest point of it
            // decides.
            EXPECT_EQ(reference::compare(bits, expected).missing, 0U) << what;
            const BitGrid truth = reference::exact_voxels(surface, whole(surface.grid));
            EXPECT_EQ(reference::compare(bits, truth).extra, 0U) << what;
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Paths, RasterMasks,
                         ::testing::Values(LayerPath::geometry_shader, LayerPath::vertex_shader));

class RasterContexts : public ::testing::Test {};

TEST_F(RasterContexts, OsmesaAndEglGiveTheSameBits) {
    const Surface surface = surface_of("builtin:knot", 48);
    std::map<Method, std::vector<BitGrid>> grids;
    int contexts = 0;
    for (const gl::ContextKind kind : {gl::ContextKind::osmesa, gl::ContextKind::egl}) {
        std::unique_ptr<gl::Context> context;
        try {
            context = gl::create_context({.kind = kind, .debug = true});
        } catch (const Error&) {
            continue;
        }
        ++contexts;
        for (const Method method : {Method::slice_map, Method::three_axis, Method::three_axis_conservative}) {
            grids[method].push_back(RasterVoxelizer(method).voxelize(upload(surface), whole(surface.grid)));
        }
        EXPECT_EQ(context->debug_log().take(), std::vector<std::string>());
    }
    if (contexts < 2) GTEST_SKIP() << "only one kind of context here";
    for (const auto& [method, bits] : grids)
        EXPECT_TRUE(same_bits(bits[0], bits[1])) << name_of(method);
}

}  // namespace
}  // namespace cairn::voxelizer

// Surfaces moved on the GPU hold the bits of snapshots taken on the CPU, and cost no memory per frame.

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/deform.h"
#include "shaders/interop/surface.h"
#include "tests/support/count_news.h"
#include "tests/support/moving_fixture.h"
#include "tests/support/moving_scenes.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;
using scenes::When;

TEST_F(Moving, HoldsTheBitsOfSnapshots) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const scenes::Scene scene = moving_zoo(seed);
        SCOPED_TRACE(fmt::format("seed {}", seed));
        expect_the_snapshots(scene, moment(0.0, 0), {-3.0, 0.0, 0.1, 0.7, 1.3, 1.999, 2.0, 50.0, 0.25}, 64);
        expect_the_snapshots(scene, {}, {0.0, 1.0}, 50);
    }
    EXPECT_GT(vertices_compared_, 20);
}

/// Coordinates of every size, so that all roundings of products, sums and of the conversion to float occur.
TEST_F(Moving, RoundsAsTheCpuDoes) {
    for (std::uint32_t seed = 10; seed < 40; ++seed) {
        Random random(seed);
        scenes::Scene scene = moving_zoo(seed);
        for (scenes::Mesh& mesh : scene.meshes)
            for (glm::vec3& p : mesh.primitives[0].positions)
                p *= float(std::exp2(20.0 * random.unit() - 15.0));
        scene.nodes[0].trs.scale *= std::exp2(30.0 * random.unit() - 15.0);
        const scenes::Bounds bounds = scenes::bounds_over_animation(scene, moment(0.0, 0), 8.0);
        // Wide, so that no vertex leaves it between the frames.
        const glm::dvec3 margin = 0.5 * (bounds.high - bounds.low);
        const Grid grid = grid_over({bounds.low - margin, bounds.high + margin}, 64);
        MovingSurface moving(scene, moment(0.0, 0), grid);
        for (const double seconds : {random.unit() * 2.0, random.unit() * 2.0}) {
            const Surface truth =
                build_surface(scene, scenes::take_snapshot(scene, moment(seconds, 0)), grid);
            ASSERT_EQ(truth.triangle_count, moving.triangle_count()) << "seed " << seed;
            ASSERT_TRUE(same_vertices(moving.move_to(seconds), truth))
                << "seed " << seed << " at " << seconds << " s";
        }
    }
}

/// A scene so far out that the last bit of a double is a good part of a lattice unit: the order of sums
/// matters.
TEST_F(Moving, FarFromTheOriginTheOrderOfOperationsHolds) {
    Random random(41);
    std::vector<glm::vec3> points;
    for (int i = 0; i < 1000; ++i)
        points.emplace_back(random.unit(), random.unit(), random.unit());
    scenes::Scene scene = points_at(points);
    scene.nodes[0].trs = {{1.1e8, -2.3e8, 3.7e8}, glm::normalize(glm::dquat(0.9, 0.1, 0.2, 0.3)), {1, 2, 3}};
    const Grid grid = grid_around(scenes::take_snapshot(scene).bounds, 64);
    const Surface truth = build_surface(scene, scenes::take_snapshot(scene), grid);
    const MovingSurface moving(scene, {}, grid);
    EXPECT_TRUE(same_vertices(moving.surface(), truth));
}

/// Points halfway between two lattice points, on either side of 0.
/// A tube of 1.75 m that two joints carry, and the same tube that its node carries.
scenes::Scene carried_tube(double far, bool by_skin) {
    constexpr int rings = 40;
    constexpr int sides = 24;
    scenes::Scene scene;
    scenes::Primitive& tube = scene.meshes.emplace_back().primitives.emplace_back();
    for (int ring = 0; ring <= rings; ++ring) {
        for (int side = 0; side < sides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / sides;
            tube.positions.emplace_back(0.3 * std::cos(angle), 1.75 * ring / rings, 0.3 * std::sin(angle));
            if (!by_skin) continue;
            const float upper = std::round(float(ring) / rings * 0x1p24F) * 0x1p-24F;
            tube.skin.push_back({{0, 1, 0, 0}, {1.0F - upper, upper, 0.0F, 0.0F}});
        }
    }
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t side = 0; side < sides; ++side) {
            const std::uint32_t next = (side + 1) % sides;
            const std::uint32_t low = ring * sides;
            tube.indices.insert(tube.indices.end(), {low + side, low + next, low + sides + side});
            tube.indices.insert(tube.indices.end(), {low + next, low + sides + next, low + sides + side});
        }
    const glm::dvec3 place(far, 0.5 * far, -far);
    scenes::Node& body = scene.nodes.emplace_back();
    body.mesh = 0;
    scene.scenes.push_back({"all", {0}});
    if (!by_skin) {
        body.trs.translation = place;
        return scene;
    }
    body.skin = 0;
    for (int joint = 1; joint <= 2; ++joint) {
        scene.nodes.emplace_back().trs.translation = place;
        scene.scenes[0].nodes.push_back(joint);
    }
    scene.skins.push_back({{1, 2}, {glm::dmat4(1.0), glm::dmat4(1.0)}});
    return scene;
}

TEST_F(Moving, ASkinFarFromTheOriginCarriesWhatANodeWould) {
    for (const double far : {1.0, 100.0, 100'000.0, 6'378'000.0}) {
        const scenes::Scene by_skin = carried_tube(far, true);
        const scenes::Scene by_node = carried_tube(far, false);
        const scenes::Snapshot truth = scenes::take_snapshot(by_node);
        const Grid grid = grid_around(truth.bounds, 256);
        const Surface expected = build_surface(by_node, truth, grid);
        const Surface on_cpu = build_surface(by_skin, scenes::take_snapshot(by_skin), grid);
        ASSERT_EQ(on_cpu.chunks.size(), 1U);
        EXPECT_EQ(on_cpu.chunks[0].positions, expected.chunks[0].positions) << far;
        const BitGrid voxels = reference::exact_voxels(expected, whole(grid));
        EXPECT_GT(voxels.count(), 50'000U);
        EXPECT_TRUE(reference::exact_voxels(on_cpu, whole(grid)) == voxels) << far;
        const MovingSurface moving(by_skin, {}, grid);
        ASSERT_FALSE(moving.was_on_cpu());
        EXPECT_TRUE(same_vertices(moving.surface(), expected)) << far;
    }
}

TEST_F(Moving, HalvesAreRoundedUp) {
    const Grid grid = unit_grid(16);
    std::vector<glm::vec3> positions;
    for (int i = -40; i <= 40; ++i) {
        const float half = float((i + 0.5) * 0x1p-20);
        positions.emplace_back(half, std::nextafter(half, 9.0F), std::nextafter(half, -9.0F));
        positions.emplace_back(half + 7.0F, half + 1.0F, -0.0F);
    }
    const scenes::Scene scene = points_at(positions);
    const Surface truth = build_surface(scene, scenes::take_snapshot(scene), grid);
    MovingSurface moving(scene, {}, grid);
    const auto ours =
        moving.surface().chunks.at(0).positions.read_all<std::array<std::int32_t, 3>>(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::i64vec3 expected = grid.lattice_from_world(positions[i]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(ours[i][axis], expected[int(axis)]) << "point " << i << ", axis " << axis;
    }
    EXPECT_EQ(grid.lattice_from_world({0.5 * 0x1p-20, -0.5 * 0x1p-20, 0.0}), glm::i64vec3(1, 0, 0));
}

TEST_F(Moving, LeavesTheCubeAndComesBack) {
    const scenes::Scene scene = sliding_triangle(8.0F);
    const Grid grid = grid_over({glm::dvec3(0.0), glm::dvec3(1.0)}, 32);
    MovingSurface moving(scene, moment(2.0, 0), grid);
    EXPECT_EQ(marker().voxelize(moving.surface(), whole(grid)).count(), 0U);
    BitGrid bits;
    for (const double seconds : {0.0, 0.12, 0.2, 1.0, 2.0, 0.05}) {
        const Surface truth = build_surface(scene, scenes::take_snapshot(scene, moment(seconds, 0)), grid);
        marker().voxelize_into(moving.move_to(seconds), whole(grid), bits);
        // Past 2 the vertices are further away than the shaders can hold, but the triangle misses the cube.
        EXPECT_FALSE(moving.was_on_cpu()) << seconds;
        EXPECT_TRUE(same_bits(bits, reference::exact_voxels(truth, whole(grid)))) << seconds;
    }
}

/// A small part of a scene: most triangles miss the cube, some pass through it.
TEST_F(Moving, APartOfASceneIsExactToo) {
    for (const std::uint32_t seed : {6U, 7U, 8U}) {
        const scenes::Scene scene = moving_zoo(seed);
        const scenes::Bounds bounds = scenes::take_snapshot(scene, moment(0.3, 0)).bounds;
        const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
        const glm::dvec3 reach = 0.15 * (bounds.high - bounds.low);
        const Grid grid = grid_over({centre - reach, centre + reach}, 40);
        MovingSurface moving(scene, moment(0.0, 0), grid);
        for (const double seconds : {0.3, 1.1, 1.8}) {
            const Surface truth =
                build_surface(scene, scenes::take_snapshot(scene, moment(seconds, 0)), grid);
            EXPECT_LT(truth.triangle_count, moving.triangle_count());
            const BitGrid bits = marker().voxelize(moving.move_to(seconds), whole(grid));
            EXPECT_EQ(moving.was_on_cpu(), !truth.far_triangles.empty()) << "seed " << seed;
            EXPECT_TRUE(same_bits(bits, reference::exact_voxels(truth, whole(grid))))
                << "seed " << seed << " at " << seconds << " s";
        }
    }
}

/// A primitive that fills the first chunk, and then the zoo, one mesh of which is cut in two.
TEST_F(Moving, SurfacesOfSeveralChunksMoveWhole) {
    scenes::Scene scene = moving_zoo(9);
    const scenes::Scene many = sliding_triangle(0.0F);
    scenes::Mesh& mesh = scene.meshes.emplace_back();
    mesh.primitives.push_back(many.meshes[0].primitives[0]);
    std::vector<std::uint32_t>& indices = mesh.primitives[0].indices;
    indices.resize(3 * (std::size_t(voxelizer::surface_chunk_triangles) - 17));
    for (std::size_t i = 0; i < indices.size(); ++i)
        indices[i] = std::uint32_t(i % 3);
    scene.nodes.emplace_back().mesh = int(scene.meshes.size()) - 1;
    auto& roots = scene.scenes[0].nodes;
    roots.insert(roots.begin(), int(scene.nodes.size()) - 1);
    const Grid grid = grid_around(scenes::bounds_over_animation(scene, moment(0.0, 0), 8.0), 16);
    MovingSurface moving(scene, moment(0.0, 0), grid);
    const Surface truth = build_surface(scene, scenes::take_snapshot(scene, moment(0.5, 0)), grid);
    ASSERT_EQ(truth.chunks.size(), 2U);
    ASSERT_EQ(truth.triangle_count, moving.triangle_count());
    EXPECT_TRUE(same_vertices(moving.move_to(0.5), truth));
}

TEST_F(Moving, TheCpuBuildsFramesThatReachTooFar) {
    scenes::Scene scene = sliding_triangle(-16.0F);
    scene.meshes[0].primitives[0].positions[1].x = 9.0F;  // one corner is far away at the start
    const Grid grid = grid_over({glm::dvec3(0.0), glm::dvec3(1.0)}, 32);
    MovingSurface moving(scene, moment(0.0, 0), grid);
    BitGrid bits;
    int on_cpu = 0;
    const std::vector<double> times = {0.0, 0.4, 0.9, 1.05, 1.15, 2.0, 0.0};
    for (const double seconds : times) {
        const Surface truth = build_surface(scene, scenes::take_snapshot(scene, moment(seconds, 0)), grid);
        marker().voxelize_into(moving.move_to(seconds), whole(grid), bits);
        EXPECT_EQ(moving.was_on_cpu(), !truth.far_triangles.empty()) << seconds;
        EXPECT_TRUE(same_bits(bits, reference::exact_voxels(truth, whole(grid)))) << seconds;
        on_cpu += moving.was_on_cpu() ? 1 : 0;
    }
    EXPECT_GT(on_cpu, 1);
    EXPECT_LT(on_cpu, int(times.size()) - 1);
}

TEST_F(Moving, SaysWhatASnapshotSaysWhenVerticesAreLost) {
    const auto fault_at = [&](float distance) {
        scenes::Scene scene = sliding_triangle(distance);
        scene.animations[0].channels[0].interpolation = scenes::Interpolation::step;
        const Grid grid = grid_over({glm::dvec3(0.0), glm::dvec3(1.0)}, 32);
        MovingSurface moving(scene, moment(0.0, 0), grid);
        try {
            moving.move_to(2.0);
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), std::isfinite(distance) ? Fault::usage : Fault::input);
            moving.move_to(0.0);  // and goes on
            EXPECT_GT(marker().voxelize(moving.surface(), whole(grid)).count(), 0U);
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(fault_at(1e9F).find("too far from so small a grid"), std::string::npos) << fault_at(1e9F);
    EXPECT_NE(fault_at(std::numeric_limits<float>::infinity()).find("infinity"), std::string::npos);
    EXPECT_EQ(fault_at(1e4F), "");
}

TEST_F(Moving, TooManyMorphTargetsAreTheCpus) {
    scenes::Scene scene = sliding_triangle(0.25F);
    auto& targets = scene.meshes[0].primitives[0].morph_targets;
    targets.resize(DEFORM_TURNS + 1);
    targets.back().positions.assign(3, {0.0F, 0.125F, 0.0F});
    scene.meshes[0].morph_weights.assign(targets.size(), 0.0F);
    scene.meshes[0].morph_weights.back() = 1.0F;
    const Grid grid = grid_over({glm::dvec3(0.0), glm::dvec3(1.0)}, 32);
    for (const bool too_many : {true, false}) {
        if (!too_many) {
            targets.erase(targets.begin());
            scene.meshes[0].morph_weights.erase(scene.meshes[0].morph_weights.begin());
        }
        MovingSurface moving(scene, moment(0.0, 0), grid);
        const Surface truth = build_surface(scene, scenes::take_snapshot(scene, moment(1.0, 0)), grid);
        moving.move_to(1.0);
        EXPECT_EQ(moving.was_on_cpu(), too_many);
        EXPECT_TRUE(same_vertices(moving.surface(), truth));
    }
}

/// Counts the calls of an OpenGL function while the object lives, through the loader's pointer.
template <auto* Pointer>
class Counted;
template <typename Result, typename... Arguments, Result (**Pointer)(Arguments...)>
class Counted<Pointer> {
public:
    Counted() {
        count_ = 0;
        original_ = *Pointer;
        *Pointer = &call;
    }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    ~Counted() { *Pointer = original_; }
    [[nodiscard]] int count() const { return count_; }

private:
    static Result call(Arguments... arguments) {
        ++count_;
        return original_(arguments...);
    }
    inline static int count_ = 0;
    inline static Result (*original_)(Arguments...) = nullptr;
};

/// All the ways in which this project creates OpenGL objects, storage and programs.
struct Creations {
    Counted<&glad_glCreateBuffers> buffers;
    Counted<&glad_glNamedBufferStorage> storage;
    Counted<&glad_glCreateTextures> textures;
    Counted<&glad_glCreateFramebuffers> framebuffers;
    Counted<&glad_glCreateShader> shaders;
    Counted<&glad_glCompileShader> compilations;
    Counted<&glad_glCreateProgram> programs;
    Counted<&glad_glLinkProgram> links;

    [[nodiscard]] int count() const {
        return buffers.count() + storage.count() + textures.count() + framebuffers.count() + shaders.count() +
               compilations.count() + programs.count() + links.count();
    }
};

TEST_F(Moving, FramesAfterTheFirstTakeNoMemoryAndBuildNoShader) {
    scenes::Scene scene = moving_zoo(4);
    // A mask cuts every other mesh: its shaders count too.
    scenes::Material& masked = scene.materials.emplace_back();
    masked.alpha_mode = scenes::AlphaMode::mask;
    masked.texture = 0;
    scene.textures.push_back({0});
    scene.images.push_back({"checks", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
    for (scenes::Mesh& mesh : scene.meshes) {
        scenes::Primitive& primitive = mesh.primitives[0];
        primitive.material = (&mesh - scene.meshes.data()) % 2 == 0 ? 0 : -1;
        for (const glm::vec3& p : primitive.positions)
            primitive.texcoords.emplace_back(p.x, p.y);
    }
    const When when = moment(0.0, 0);
    const Grid grid = grid_around(scenes::bounds_over_animation(scene, when, 8.0), 96);
    {
        const Creations created;
        MovingSurface moving(scene, when, grid, {.attributes = true});
        EXPECT_GT(created.count(), 0) << "nothing is counted";
        BitGrid bits;
        marker().voxelize_into(moving.surface(), whole(grid), bits);
        EXPECT_GT(marker().voxelize_pyramid(moving.surface(), whole(grid)).level_count(), 1);
    }
    MovingSurface moving(scene, when, grid, {.attributes = true});
    BitGrid bits;
    marker().voxelize_into(moving.surface(), whole(grid), bits);
    const Creations created;
    // Twice: in the first round, llvmpipe's compiler takes memory at the first use of each program.
    for (int frame = 0; frame < 80; ++frame) {
        const std::size_t news_before = news();
        const std::uint32_t* const words = bits.words.data();
        const GpuSurface& surface = moving.move_to(frame % 40 / 20.0);
        marker().voxelize_into(surface, whole(grid), bits);
        const std::size_t taken = news() - news_before;
        EXPECT_EQ(frame < 40 ? 0 : taken, 0U) << "frame " << frame;
        EXPECT_EQ(bits.words.data(), words) << "frame " << frame;
        EXPECT_GT(bits.count(), 0U) << "frame " << frame;
        EXPECT_FALSE(moving.was_on_cpu()) << "frame " << frame;
        EXPECT_TRUE(marker().voxelize_pyramid(surface, whole(grid)).level(0) == bits);
    }
    const Surface truth = build_surface(scene, scenes::take_snapshot(scene, moment(39 / 20.0, 0)), grid);
    EXPECT_TRUE(truth.has_mask);
    EXPECT_TRUE(same_bits(bits, reference::exact_voxels(truth, whole(grid))));
    EXPECT_EQ(created.count(), 0) << created.buffers.count() << " buffers, " << created.programs.count()
                                  << " programs";
}

TEST_F(Moving, BoundsEncloseEveryFrame) {
    const scenes::Scene scene = moving_zoo(5);
    const When when = moment(0.0, 0);
    const std::vector<double> times = scenes::frame_times(scene, when, 30.0);
    ASSERT_EQ(times.size(), 61U);
    EXPECT_EQ(times.front(), 0.0);
    EXPECT_EQ(times[15], 0.5);
    EXPECT_EQ(times.back(), 2.0);
    const scenes::Bounds all = scenes::bounds_over_animation(scene, when, 30.0);
    scenes::Bounds seen;
    for (const double seconds : times) {
        const scenes::Bounds frame = scenes::take_snapshot(scene, moment(seconds, 0)).bounds;
        seen.add(frame.low);
        seen.add(frame.high);
    }
    EXPECT_EQ(all.low, seen.low);
    EXPECT_EQ(all.high, seen.high);
    EXPECT_EQ(scenes::frame_times(scene, {}, 30.0), std::vector<double>{0.0});
    EXPECT_THROW((void)scenes::frame_times(scene, when, 0.0), Error);
    EXPECT_THROW((void)scenes::frame_times(scene, when, 1e9), Error);
    EXPECT_THROW((void)scenes::frame_times(scene, moment(0.0, 1), 30.0), Error);
}

TEST_F(Moving, AnEmptySceneHasNoVoxels) {
    scenes::Scene scene;
    scene.scenes.resize(1);
    const Grid grid = unit_grid(8);
    MovingSurface moving(scene, {}, grid);
    EXPECT_EQ(marker().voxelize(moving.move_to(1.0), whole(grid)).count(), 0U);
}

#ifdef CAIRN_SCENE_DATA
class MovingData : public Moving, public ::testing::WithParamInterface<const char*> {};

/// Plays every animation of the scene, within and beyond its ends, and the rest pose.
TEST_P(MovingData, HoldsTheBitsOfSnapshots) {
    const scenes::Scene scene = scenes::load(std::string(CAIRN_SCENE_DATA) + "/" + GetParam());
    expect_the_snapshots(scene, {}, {0.0}, 64);
    for (int animation = 0; animation < int(scene.animations.size()); ++animation) {
        const double duration = scene.animations[std::size_t(animation)].duration;
        expect_the_snapshots(scene, moment(0.0, animation),
                             {-1.0, 0.0, 0.21 * duration, 0.5 * duration, 0.83 * duration, duration, 1e6},
                             64);
    }
    EXPECT_GT(vertices_compared_, 0);
}

std::string name_of(const ::testing::TestParamInfo<const char*>& info) {
    std::string name = info.param;
    name = name.substr(name.find_last_of('/') + 1);
    std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
    return name;
}

#define SKINS "asset-generator/Animation_Skin/Animation_Skin_"
#define NODES "asset-generator/Animation_Node/Animation_Node_"
INSTANTIATE_TEST_SUITE_P(
    Data, MovingData,
    ::testing::Values("gltf/CesiumMan.glb", "gltf/Fox.glb", "gltf/InterpolationTest/InterpolationTest.gltf",
                      "gltf/MorphStressTest/MorphStressTest.gltf", "gltf/generic_hand_left.glb",
                      NODES "00.gltf", NODES "01.gltf", NODES "02.gltf", NODES "03.gltf", NODES "04.gltf",
                      NODES "05.gltf", SKINS "00.gltf", SKINS "01.gltf", SKINS "02.gltf", SKINS "03.gltf",
                      SKINS "04.gltf", SKINS "05.gltf", SKINS "06.gltf", SKINS "07.gltf", SKINS "08.gltf",
                      SKINS "09.gltf", SKINS "10.gltf", SKINS "11.gltf"),
    name_of);
#endif

}  // namespace
}  // namespace cairn::voxelizer

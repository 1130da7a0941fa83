// Real scenes, bit by bit against the exact reference.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/voxelizer_fixture.h"
#include "voxelizer/methods/conservative_voxelizer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

struct SceneAt {
    const char* path;
    std::vector<int> resolutions;
};

void PrintTo(const SceneAt& scene, std::ostream* out) {
    *out << std::string_view(scene.path).substr(std::string_view(scene.path).find_last_of('/') + 1);
}

class RealScene : public GlTest, public ::testing::WithParamInterface<SceneAt> {};

TEST_P(RealScene, HasTheBitsOfTheExactReference) {
    const scenes::Scene scene = scenes::load(GetParam().path);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    ConservativeVoxelizer voxelizer;
    for (const int resolution : GetParam().resolutions) {
        const Surface surface = build_surface(scene, snapshot, grid_around(snapshot.bounds, resolution));
        const Region region = whole(surface.grid);
        const BitGrid truth = reference::exact_voxels(surface, region);
        EXPECT_TRUE(same_bits(voxelizer.voxelize(upload(surface), region), truth))
            << "resolution " << resolution;
        EXPECT_GT(truth.count(), 0U);
    }
}

std::string name_of(const ::testing::TestParamInfo<SceneAt>& info) {
    std::string name = info.param.path;
    name = name.substr(name.find_last_of("/:") + 1);
    name = name.substr(0, name.find('.'));
    std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
    return name;
}

INSTANTIATE_TEST_SUITE_P(Builtin, RealScene,
                         ::testing::Values(SceneAt{"builtin:knot", {64, 100, 256}},
                                           SceneAt{"builtin:needles", {64, 256}},
                                           SceneAt{"builtin:cornell", {33, 128}}),
                         name_of);

#ifdef CAIRN_ENGINE
INSTANTIATE_TEST_SUITE_P(Assimp, RealScene, ::testing::Values(SceneAt{CAIRN_ENGINE, {64, 128, 256}}),
                         name_of);
#endif

#ifdef CAIRN_SCENE_DATA
#define DATA CAIRN_SCENE_DATA "/gltf/"
#define MASKS CAIRN_SCENE_DATA "/asset-generator/Material_AlphaMask/Material_AlphaMask_0"
INSTANTIATE_TEST_SUITE_P(
    Data, RealScene,
    ::testing::Values(SceneAt{DATA "stanford_bunny_69k.glb", {64, 128, 256}},
                      SceneAt{DATA "dutch_ship/dutch_ship_medium_1k.gltf", {64, 128, 256}},
                      SceneAt{DATA "CornellBox.glb", {64, 128, 256}},
                      SceneAt{DATA "TwoSidedPlane/TwoSidedPlane.gltf", {64, 128, 256}},
                      SceneAt{DATA "big_and_tiny_triangles_quantized.glb", {64, 128, 256}},
                      SceneAt{DATA "tree_mask.glb", {32, 100}}, SceneAt{MASKS "0.gltf", {64}},
                      SceneAt{MASKS "1.gltf", {64}}, SceneAt{MASKS "2.gltf", {64}},
                      SceneAt{MASKS "5.gltf", {64}}, SceneAt{MASKS "6.gltf", {64}}),
    name_of);

// ---- Every file, as far as it is quick; `cairn bench check` looks at all of them, finely
// -----------------------------

constexpr std::uint64_t most_triangles = 250000;
constexpr int coarse = 64;

/// Files of one folder, as paths in CAIRN_SCENE_DATA.
struct Files {
    std::string name;
    std::vector<std::string> paths;
};

void PrintTo(const Files& files, std::ostream* out) {
    *out << files.name;
}

/// Each of gltf/ alone, and those of each folder of asset-generator/ together, which are tiny.
std::vector<Files> all_files() {
    namespace fs = std::filesystem;
    std::vector<Files> out;
    const fs::path data = CAIRN_SCENE_DATA;
    const auto is_scene = [](const fs::path& path) {
        return path.extension() == ".gltf" || path.extension() == ".glb";
    };
    for (const auto& entry : fs::recursive_directory_iterator(data / "gltf")) {
        if (is_scene(entry.path())) out.push_back({entry.path().stem().string(), {entry.path().string()}});
    }
    for (const auto& folder : fs::directory_iterator(data / "asset-generator")) {
        if (!folder.is_directory()) continue;
        Files& files = out.emplace_back(Files{folder.path().stem().string(), {}});
        for (const auto& entry : fs::directory_iterator(folder)) {
            if (is_scene(entry.path())) files.paths.push_back(entry.path().string());
        }
    }
    for (Files& files : out)
        std::erase_if(files.name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
    std::ranges::sort(out, {}, &Files::name);
    return out;
}

class EveryFile : public ConservativeTest, public ::testing::WithParamInterface<Files> {
protected:
    void check(const Surface& surface, const Region& region, const std::string& what) {
        const BitGrid truth = reference::exact_voxels(surface, region);
        EXPECT_TRUE(same_bits(voxelizer().voxelize(upload(surface), region), truth)) << what;
        const bool may_be_empty = surface.triangle_count == 0 || surface.has_mask;
        EXPECT_TRUE(truth.count() > 0 || may_be_empty) << what << ": there is nothing to compare";
    }

    void check_deep_tiles(const Surface& surface) {
        for (const int level : {9, 14, 19, 24}) {
            const glm::ivec3 voxel = random_vertex(surface) >> (LATTICE_BITS - level);
            check(surface, {level, voxel - glm::ivec3(random_.point(0, 11)), glm::ivec3(12)},
                  fmt::format("a tile at level {}", level));
        }
    }

    /// Compares in a grid that most triangles reach far past.
    void check_tiny_bounds(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                           const Surface& whole_surface) {
        const double extent = whole_surface.grid.voxel_size * coarse;
        for (const double part : {1e-1, 1e-2, 1e-4}) {
            const glm::dvec3 middle = whole_surface.grid.origin + glm::dvec3(random_vertex(whole_surface)) *
                                                                      whole_surface.grid.lattice_unit();
            scenes::Bounds bounds;
            bounds.add(middle - 0.5 * part * extent);
            bounds.add(middle + 0.5 * part * extent);
            const Surface surface = build_surface(scene, snapshot, grid_over(bounds, 24));
            check(surface, whole(surface.grid), fmt::format("a grid over a part of {}", part));
        }
    }

    /// Compares a file at rest and in the middle of its first animation.
    static std::vector<scenes::When> moments(const scenes::Scene& scene) {
        std::vector<scenes::When> out(1);
        if (!scene.animations.empty())
            out.push_back({.seconds = 0.5 * scene.animations[0].duration, .animation = 0, .scene_index = {}});
        return out;
    }

private:
    glm::ivec3 random_vertex(const Surface& surface) {
        const auto& positions = surface.chunks[0].positions;
        const auto& vertex = positions[std::size_t(random_.between(0, std::ssize(positions) - 1))];
        return {vertex[0], vertex[1], vertex[2]};
    }

    std::optional<ConservativeVoxelizer> voxelizer_;
    Random random_{81};
};

TEST_P(EveryFile, IsExactAsAWholeInDeepTilesAndInTinyBounds) {
    for (const std::string& path : GetParam().paths) {
        const scenes::Scene scene = scenes::load(path);
        for (const scenes::When& when : moments(scene)) {
            SCOPED_TRACE(fmt::format("{} at {} s", path, when.seconds));
            const scenes::Snapshot snapshot = scenes::take_snapshot(scene, when);
            if (snapshot.triangle_count > most_triangles) GTEST_SKIP() << "too large to be quick";
            const Surface surface = build_surface(scene, snapshot, grid_around(snapshot.bounds, coarse));
            check(surface, whole(surface.grid), "the whole");
            if (surface.chunks.empty()) continue;  // a mask hides all of it
            check_deep_tiles(surface);
            check_tiny_bounds(scene, snapshot, surface);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Data, EveryFile, ::testing::ValuesIn(all_files()),
                         [](const auto& test) { return test.param.name; });
#endif

}  // namespace
}  // namespace cairn::voxelizer

// Real scenes, bit by bit against the exact reference.
#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/gl_fixture.h"
#include "tests/lattice_surface.h"
#include "voxelizer/conservative_voxelizer.h"

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
#endif

}  // namespace
}  // namespace cairn::voxelizer

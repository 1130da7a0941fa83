// `cairn shadow`, run as a user runs it.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

using Arguments = std::vector<std::string>;

Arguments joined(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

nlohmann::json compared(const std::string& scene, const Arguments& options) {
    return cairn_json(joined({"shadow", scene, "--compare", "embree", "--quiet"}, options));
}

/// Figures of the hard shadow of the finest voxels.
nlohmann::json hard(const std::string& scene, int resolution) {
    return compared(scene, {"--method", "voxel", "--size", "300x225", "--pixel-error", "0.001",
                            "--brick-pool", "1024", "--max-resolution", std::to_string(resolution)});
}

/// Forest et al. 2009 find 11% of the shadowed pixels wrong at 512^3 and 4% at 2048^3.
void expect_few_wrong(const std::string& scene) {
    for (const auto& [resolution, limit] : {std::pair{512, 0.04}, {2048, 0.015}}) {
        const auto figures = hard(scene, resolution);
        EXPECT_LT(figures["hard_disagreement"], limit) << scene << " at " << resolution << ": " << figures;
        EXPECT_GT(figures["shadowable_pixels"], 5000);
        EXPECT_GT(figures["shadowed_pixels"], 200);
    }
}

TEST(AppShadow, HardVoxelShadowsAgreeWithEmbree) {
    expect_few_wrong("builtin:knot");
}

TEST(AppShadow, HardVoxelShadowsOfManySpheresAgreeWithEmbree) {
    expect_few_wrong("builtin:spheres");
}

#ifdef CAIRN_SCENE_DATA
TEST(AppShadow, HardVoxelShadowsOfTheBunnyAgreeWithEmbree) {
    expect_few_wrong(CAIRN_SCENE_DATA "/gltf/stanford_bunny_69k.glb");
}
#endif

TEST(AppShadow, SoftVoxelShadowsOfEveryLightAgreeWithEmbree) {
    for (const Arguments& light : {Arguments{"--light", "3,5,3,0.8"},
                                   {"--light", "3,5,3", "--light-disk", "0.8"},
                                   {"--light", "3,5,3", "--light-size", "1.5,1"},
                                   {"--light-direction", "0.4,0.8,0.45,5"}}) {
        const auto figures =
            compared("builtin:knot", joined({"--method", "voxel", "--size", "120x90", "--pixel-error",
                                             "0.001", "--max-resolution", "1024", "--rays", "64"},
                                            light));
        EXPECT_EQ(figures["rays"], 64);
        // The samples' error is under 0.01. The rest comes from rays near the receiver's horizon, which meet
        // voxels that are thicker than their surface, and see less of the light.
        EXPECT_LT(figures["rmse"], 0.075) << light[0] << " " << light[1] << ": " << figures;
        EXPECT_LT(figures["mean_absolute_error"], 0.02) << light[0] << " " << light[1];
    }
}

const Arguments blocks_in_a_box = {
    "--light", "0,2.5,0.1",   "--light-size", "1,1",         "--light-target", "0,0,0",       "--size",
    "90x90",   "--receivers", "walls",        "--occluders", "short block",    "--occluders", "tall block"};

TEST(AppShadow, EveryMethodIsNearTheTruthInASimpleScene) {
    const std::pair<Arguments, double> methods[] = {
        {{"--method", "embree"}, 0.02},
        {{"--method", "voxel", "--pixel-error", "0.001", "--max-resolution", "512"}, 0.05},
        {{"--method", "soft-shadow-map", "--format", "fp16-batches", "--passes", "two", "--map-size", "256"},
         0.12}};
    for (const auto& [method, limit] : methods) {
        const auto figures = compared("builtin:cornell", joined(blocks_in_a_box, method));
        EXPECT_LT(figures["rmse"], limit) << method[1] << ": " << figures;
        EXPECT_GT(figures["shadowable_pixels"], 1000) << method[1];
        EXPECT_GT(figures["shadowed_pixels"], 100) << method[1];
        for (const char* const name :
             {"milliseconds", "hard_disagreement", "mean_absolute_error", "max_error", "driver"})
            EXPECT_TRUE(figures.contains(name)) << method[1] << ": " << name;
    }
}

TEST(AppShadow, WritesPicturesThatAreTheSameEveryTime) {
    const ScratchFolder folder;
    const auto run = [&](const std::string& name) {
        const Answer answer =
            cairn({"shadow", "builtin:knot", "--method", "voxel", "--light", "3,5,3,0.8", "--rays", "16",
                   "--size", "90x60", "--compare", "embree", "-o", folder.file(name + ".png"), "--difference",
                   folder.file(name + "_difference.png"), "--quiet"});
        EXPECT_EQ(answer.code, 0) << answer;
        return read_text(folder.file(name + ".png")) + read_text(folder.file(name + "_difference.png"));
    };
    EXPECT_EQ(run("first"), run("second"));
    EXPECT_GT(read_text(folder.file("first_difference.png")).size(), 100U);
}

TEST(AppShadow, RenderTakesSoftShadowsToo) {
    const ScratchFolder folder;
    const auto picture = [&](const Arguments& options) {
        const Answer answer = cairn(joined(
            {"render", "builtin:knot", "--size", "90x60", "-o", folder.file("p.png"), "--quiet"}, options));
        EXPECT_EQ(answer.code, 0) << answer;
        return read_text(folder.file("p.png"));
    };
    const std::string point = picture({"--light", "3,5,3"});
    EXPECT_EQ(picture({"--light", "3,5,3,0.8"}), point) << "hard shadows are those of the middle";
    EXPECT_EQ(picture({"--light", "3,5,3", "--shadow", "soft"}), point) << "a point has hard shadows";
    EXPECT_NE(picture({"--light", "3,5,3,0.8", "--shadow", "soft"}), point);
}

TEST(AppShadow, WrongOptionsAreRefusedBeforeAnythingIsWritten) {
    const ScratchFolder folder;
    const Arguments wrong[] = {
        {},
        {"--method", "guess"},
        {"--method", "voxel", "--compare", "voxel"},
        {"--method", "voxel", "--rays", "0"},
        {"--method", "voxel", "--rays", "513"},
        {"--method", "voxel", "--light-size", "1,1"},
        {"--method", "voxel", "--light", "1,2,3,-1"},
        {"--method", "voxel", "--light", "1,2,3,1", "--light-size", "1,1"},
        {"--method", "voxel", "--light", "1,2,3", "--light-size", "0,1"},
        {"--method", "voxel", "--light", "1,2,3", "--light-size", "1,1", "--light-disk", "1"},
        {"--method", "voxel", "--light", "1,2,3", "--light-direction", "0,1,0"},
        {"--method", "voxel", "--light", "1,2,3", "--light-target", "0,1,0"},
        {"--method", "voxel", "--light-direction", "0,0,0"},
        {"--method", "voxel", "--light-direction", "0,1,0,90"},
        {"--method", "voxel", "--map-size", "64"},
        {"--method", "voxel", "--receivers", "nothing"},
        {"--method", "voxel", "--difference", folder.file("d.png")},
        {"--method", "soft-shadow-map", "--light", "1,2,3", "--receivers", "0"},
        {"--method", "soft-shadow-map", "--light", "1,2,3", "--light-size", "1,1"},
        {"--method", "soft-shadow-map", "--light", "1,2,3", "--light-size", "1,1", "--receivers", "0",
         "--rays", "4"},
        // Options that would change nothing.
        {"--method", "voxel", "--rays", "4"},
        {"--method", "voxel", "--light", "1,2,3", "--rays", "4"},
        {"--method", "voxel", "--light", "1,2,3", "--cones"},
        {"--method", "voxel", "--truth-samples", "100"},
        {"--method", "pyramid", "--truth-cache", folder.file("cache")},
        {"--method", "pyramid", "--pixel-error", "2"},
        {"--method", "pyramid", "--brick-pool", "64"},
        {"--method", "embree", "--max-resolution", "64"},
        {"--method", "embree", "--brick-cache", "64"}};
    for (const Arguments& options : wrong) {
        const Answer answer = cairn(joined({"shadow", "builtin:knot", "-o", folder.file("o.png")}, options));
        EXPECT_EQ(answer.code, 2) << answer;
        EXPECT_FALSE(std::filesystem::exists(folder.file("o.png")));
    }
    EXPECT_EQ(cairn({"shadow", folder.file("no.glb"), "--method", "embree"}).code, 3);
}

}  // namespace
}  // namespace cairn::test

// `cairn shadow --method pyramid`, `--ground` and `cairn bench moving-shadow`, run as a user runs them.

#include <filesystem>
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

TEST(AppPyramid, ShadowsOfEveryLightAgreeWithEmbree) {
    for (const Arguments& light : {Arguments{"--light", "3,5,3,0.8"},
                                   {"--light", "3,5,3", "--light-disk", "0.8"},
                                   {"--light", "3,5,3", "--light-size", "1.5,1"},
                                   {"--light-direction", "0.4,0.8,0.45,5"},
                                   {"--light-direction", "0.4,0.8,0.45"}}) {
        const auto figures = cairn_json(joined({"shadow", "builtin:knot", "--method", "pyramid", "--size",
                                                "120x90", "--compare", "embree", "--quiet"},
                                               light));
        EXPECT_EQ(figures["max_resolution"], 512);
        EXPECT_GT(figures["shadowed_pixels"], 50) << light[0] << " " << light[1];
        EXPECT_LT(figures["hard_disagreement"], 0.03) << light[0] << " " << light[1] << ": " << figures;
        EXPECT_GT(figures["voxelize_ms"], 0.0);
        EXPECT_GT(figures["pyramid_ms"], 0.0);
    }
}

TEST(AppPyramid, TheGroundIsShadowedByEveryMethod) {
    const auto run = [](const Arguments& method, const Arguments& options) {
        return cairn_json(joined(joined({"shadow", "builtin:knot", "--size", "90x60", "--light", "2,6,2,0.5",
                                         "--rays", "16", "--compare", "embree", "--quiet"},
                                        method),
                                 options));
    };
    for (const Arguments& method :
         {Arguments{"--method", "voxel"}, {"--method", "pyramid"}, {"--method", "embree"}}) {
        const auto with = run(method, {"--ground", "--receivers", "ground", "--camera", "0,6,6,0,0,0"});
        EXPECT_GT(with["shadowable_pixels"], 500) << method[1] << ": " << with;
        EXPECT_GT(with["shadowed_pixels"], 20) << method[1] << ": " << with;
        EXPECT_LT(with["hard_disagreement"], 0.05) << method[1] << ": " << with;
    }
    const Answer without = cairn({"shadow", "builtin:knot", "--method", "pyramid", "--receivers", "ground"});
    EXPECT_EQ(without.code, 2) << without;
}

TEST(AppPyramid, OtherResolutionsAreRefusedBeforeAnythingIsWritten) {
    const ScratchFolder folder;
    for (const char* const resolution : {"100", "4096"}) {
        const Answer answer = cairn({"shadow", "builtin:knot", "--method", "pyramid", "--max-resolution",
                                     resolution, "-o", folder.file("o.png")});
        EXPECT_EQ(answer.code, 2) << answer;
        EXPECT_NE(answer.err.find("power of two"), std::string::npos) << answer;
        EXPECT_FALSE(std::filesystem::exists(folder.file("o.png")));
    }
}

#ifdef CAIRN_SCENE_DATA
TEST(AppPyramid, AMovingSceneCastsAnotherShadowAtAnotherTime) {
    const ScratchFolder folder;
    const auto picture = [&](const char* seconds) {
        const Answer answer =
            cairn({"shadow", CAIRN_SCENE_DATA "/gltf/Fox.glb", "--method", "pyramid", "--ground", "--time",
                   seconds, "--size", "90x60", "-o", folder.file("p.png"), "--quiet"});
        EXPECT_EQ(answer.code, 0) << answer;
        return read_text(folder.file("p.png"));
    };
    EXPECT_EQ(picture("0.5"), picture("0.5"));
    EXPECT_NE(picture("0.5"), picture("1.0"));
}

#ifdef CAIRN_BENCH
TEST(AppPyramid, TheChartOfMovingScenesHasTimesAndErrors) {
    const ScratchFolder folder;
    const auto answer =
        cairn_json({"bench", "moving-shadow", "--scene", CAIRN_SCENE_DATA "/gltf/Fox.glb", "--resolutions",
                    "64", "--runs", "1", "-o", folder.path().string(), "--quiet"});
    const auto& rows = answer["measurements"];
    ASSERT_EQ(rows.size(), 3U);
    for (const auto& row : rows) {
        EXPECT_GT(row["frames"], 1) << row;
        for (const char* const part : {"move_ms", "voxelize_ms", "pyramid_ms", "raster_ms", "trace_ms"})
            EXPECT_GT(row[part], 0.0) << part << ": " << row;
        EXPECT_EQ(row["checked"], 3) << row;
        EXPECT_GT(row["rmse"], 0.0) << row;
        EXPECT_LT(row["hard_disagreement"], 0.1) << row;
    }
    const Answer still =
        cairn({"bench", "moving-shadow", "--scene", "builtin:knot", "-o", folder.path().string()});
    EXPECT_EQ(still.code, 2) << still;
}
#endif
#endif

}  // namespace
}  // namespace cairn::test

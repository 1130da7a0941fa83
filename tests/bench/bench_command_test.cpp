// `cairn bench`, run as a user runs it, at tiny sizes.
#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

TEST(BenchVoxelize, WritesATableOfEveryMethodAndAPicture) {
    const ScratchFolder folder;
    const nlohmann::json answer =
        cairn_json({"bench", "voxelize", "--scene", "builtin:cornell", "--resolutions", "16,8", "--runs", "1",
                    "-o", folder.file("charts")});
    const std::vector<std::string> lines = lines_of(read_text(folder.file("charts/voxelize.csv")));
    ASSERT_GE(lines.size(), 1U + 2U * 3U);
    EXPECT_EQ(lines[0], "scene,resolution,method,triangles,occupied,missing,extra,error,ms,threads,driver");
    for (const char* row : {"cornell,8,conservative,", "cornell,16,conservative,",
                            "cornell,16,three-directions,", "cornell,16,cpu-row-span,"}) {
        EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
            return line.starts_with(row);
        })) << row;
    }
    for (const nlohmann::json& row : answer["measurements"]) {
        EXPECT_GT(row["milliseconds"], 0.0) << row;
        const std::string method = row["method"];
        if (method == "conservative" || method == "cpu-row-span") {
            EXPECT_EQ(row["missing"], 0) << row;
            EXPECT_EQ(row["extra"], 0) << row;
            EXPECT_GT(row["occupied"], 0) << row;
        }
        EXPECT_EQ(row.contains("error"), method != "three-directions") << row;
    }
#ifdef CAIRN_HAS_GNUPLOT
    EXPECT_TRUE(read_text(folder.file("charts/voxelize.png"))
                    .starts_with("\x89"
                                 "PNG"));
#endif
}

TEST(BenchVoxelize, SaysThatGnuplotIsMissingAndStillWritesTheTable) {
    const ScratchFolder folder;
    const Answer answer = cairn({"bench", "voxelize", "--scene", "builtin:cornell", "--resolutions", "8",
                                 "--runs", "1", "-o", folder.path().string()},
                                {.environment = {{"PATH", folder.path().string()}}});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_NE(answer.err.find("gnuplot is not installed"), std::string::npos) << answer;
    EXPECT_TRUE(std::filesystem::exists(folder.file("voxelize.csv")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("voxelize.png")));
}

/// Runs a chart at a tiny size, and checks the CSV's header and number of rows. @return its rows.
nlohmann::json rows_of(const std::string& chart, const std::string& size, const std::string& scene,
                       const ScratchFolder& folder, const std::string& columns = {}) {
    std::vector<std::string> words = {"bench", chart, "--resolutions",       size, "--runs",
                                      "1",     "-o",  folder.path().string()};
    if (!scene.empty()) words.insert(words.end(), {"--scene", scene});
    nlohmann::json rows = cairn_json(words)["measurements"];
    std::string file = chart + ".csv";
    std::replace(file.begin(), file.end(), '-', '_');
    const std::vector<std::string> lines = lines_of(read_text(folder.file(file)));
    EXPECT_EQ(lines.size(), rows.size() + 1) << chart;
    if (columns.empty()) {
        EXPECT_TRUE(lines[0].ends_with(",driver,threads")) << lines[0];
    } else {
        EXPECT_EQ(lines[0], columns);
    }
    return rows;
}

TEST(BenchEmbree, ComparesWithSingleRaysAndPackets) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("embree", "32", "builtin:cornell", folder);
    ASSERT_GE(rows.size(), 2U);
    EXPECT_EQ(rows[0]["method"], "embree-single");
    EXPECT_EQ(rows[1]["method"], "embree-packets");
    for (const nlohmann::json& row : rows) {
        EXPECT_GT(row["milliseconds"], 0.0) << row;
        EXPECT_GT(row["ours_ms"], 0.0) << row;
        EXPECT_GT(row["bricks"], 0) << row;
    }
}

TEST(BenchRender, HasTheSamePictureByAllTraversalsAndPools) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("render", "32", "builtin:cornell", folder);
    const auto base = std::find_if(rows.begin(), rows.end(), [](const nlohmann::json& row) {
        return row["varied"] == "shape" && row["n"] == 4 && row["m"] == 16 && row["pixel_error"] == 1.0;
    });
    ASSERT_NE(base, rows.end());
    int others = 0;
    int sampled = 0;
    int met = 0;
    for (const nlohmann::json& row : rows) {
        EXPECT_GT(row["rmse"], 0.0) << row;
        EXPECT_LT(row["rmse"], 0.3) << row;
        EXPECT_GT(row["bricks_used"], 0) << row;
        if (row["varied"] == "shape") continue;
        if (row["varied"] == "geometry") {
            ++met;
            if (row["geometry"] == "voxel" && row["pixel_error"] == 1.0) {
                EXPECT_GT(row["rmse"], 1.2 * (*base)["rmse"].get<double>()) << row;
            }
            continue;
        }
        if (row["varied"] == "samples") {
            if (row["samples"] == 16 && row["pixel_error"] == 1.0) {
                ++sampled;
                EXPECT_LT(row["rmse"], 0.7 * (*base)["rmse"].get<double>()) << row;
            }
            continue;
        }
        ++others;
        EXPECT_EQ(row["rmse"], (*base)["rmse"]) << row;
        EXPECT_EQ(row["silhouette"], (*base)["silhouette"]) << row;
    }
    EXPECT_GE(others, 4);
    EXPECT_EQ(sampled, 1);
    EXPECT_EQ(met, 12);
#ifdef CAIRN_HAS_GNUPLOT
    EXPECT_TRUE(read_text(folder.file("render.png"))
                    .starts_with("\x89"
                                 "PNG"));
#endif
}

TEST(BenchResolution, StaysWithinThePools) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("resolution", "32,128", "builtin:spheres-repeated", folder);
    ASSERT_EQ(rows.size(), 4U);
    for (const nlohmann::json& row : rows) {
        EXPECT_GT(row["bricks_used"], 0) << row;
        EXPECT_LE(row["bricks_resident"], row["brick_slots"]) << row;
    }
    EXPECT_EQ(rows[0]["growth"], 1.0);
    EXPECT_GT(rows[1]["bricks_used"], rows[0]["bricks_used"]);
}

TEST(BenchStructure, HasTheSamePictureAsARegularGrid) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("structure", "32", "", folder);
    std::map<std::string, int> methods;
    std::map<double, double> apart;
    for (const nlohmann::json& row : rows) {
        ++methods[row["method"]];
        EXPECT_LT(row["coverage_difference"], 0.03) << row;
        if (row["method"] == "regular-grid" || row["varied"] != "place") continue;
        const auto [known, is_new] = apart.try_emplace(row["place"], row["coverage_difference"]);
        if (!is_new) {
            EXPECT_EQ(row["coverage_difference"], known->second) << row;
        }
    }
    EXPECT_EQ(methods["regular-grid"], 5);
    EXPECT_EQ(methods["restart"], 4);
    EXPECT_EQ(methods["stackless"], 4);
    EXPECT_GE(methods["mini-stack"], 4 + 3);
}

TEST(BenchExploration, CountsWhatAMovingCameraNeeds) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("exploration", "32", "builtin:cornell", folder);
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(rows[0]["part"], "exploration");
    EXPECT_GT(rows[0]["bricks"], 0.0);
    EXPECT_EQ(rows[1]["part"], "steady");
    EXPECT_GT(rows[1]["bricks"], 0.0);
    for (const nlohmann::json& row : rows) {
        EXPECT_GE(row["milliseconds"], row["render_ms"]) << row;
        EXPECT_GE(row["passes"], 1.0) << row;
        const double parts = double(row["bricks_ms"]) + double(row["upload_ms"]) + double(row["tree_ms"]);
        EXPECT_GE(row["milliseconds"], parts) << row;
        EXPECT_GE(row["bricks_ms"], 0.0) << row;
        EXPECT_GT(row["upload_ms"], 0.0) << row;
        if (row["part"] != "exploration" && row["part"] != "steady") {
            EXPECT_EQ(row["bricks"], 0.0) << row;
        }
    }
}

TEST(BenchExploration, ExploresTheSpongeInATreeOfItsOwn) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("exploration", "24", "builtin:sponge", folder);
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(rows[0]["scene"], "sponge");
    EXPECT_GT(rows[0]["bricks"], 0.0);
}

TEST(BenchProduction, ProducesWhatIsUsed) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("production", "64", "builtin:cornell", folder);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_GT(rows[0]["bricks_used"], 0);
    EXPECT_GE(rows[0]["bricks_produced"], rows[0]["bricks_used"]);
    EXPECT_LT(rows[0]["produced_over_used"], 1.3);
    EXPECT_GT(rows[0]["brick_ms"], 0.0);
}

TEST(BenchVisibility, RaysProduceLessThanQueriesAndQueriesLessThanTheFrustum) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("visibility", "48", "builtin:knot", folder);
    ASSERT_EQ(rows.size(), 3U * 4U);
    const std::vector<std::string> schemes = {"ray-guided", "occlusion-query", "occlusion-query-waiting",
                                              "frustum"};
    std::int64_t by_rays = 0, by_frustum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const nlohmann::json& row = rows[i];
        EXPECT_EQ(row["scheme"], schemes[i % 4]) << row;
        EXPECT_EQ(row["view"], rows[i / 4 * 4]["view"]) << row;
        EXPECT_EQ(row["missed"], 0) << row;
        EXPECT_GT(row["bricks_used"], 0) << row;
        EXPECT_GE(row["bricks_produced"], rows[i / 4 * 4]["bricks_produced"]) << row;
        EXPECT_LE(row["bricks_produced"], rows[i / 4 * 4 + 3]["bricks_produced"]) << row;
        EXPECT_EQ(row["queries"] > 0, i % 4 == 2 || (i % 4 == 1 && row["passes"] > 1)) << row;
        EXPECT_GE(row["passes"], 1) << row;
        (i % 4 == 0 ? by_rays : by_frustum) += i % 4 % 3 == 0 ? row["bricks_produced"].get<int>() : 0;
    }
    EXPECT_LT(by_rays, by_frustum);
}

TEST(BenchCheck, FindsASceneTheSameAtRestAndInMotion) {
    const ScratchFolder folder;
    const nlohmann::json rows =
        rows_of("check", "16,33", "builtin:cornell", folder,
                "scene,animation_seconds,resolution,triangles,occupied,missing,extra,outcome,seconds,driver");
    ASSERT_EQ(rows.size(), 2U);
    for (const nlohmann::json& row : rows) {
        EXPECT_EQ(row["scene"], "builtin:cornell") << row;
        EXPECT_FALSE(row.contains("animation_seconds")) << row;
        EXPECT_EQ(row["outcome"], "same") << row;
        EXPECT_EQ(row["missing"], 0) << row;
        EXPECT_EQ(row["extra"], 0) << row;
        EXPECT_GT(row["occupied"], 0) << row;
        const nlohmann::json alone = cairn_json({"check", "builtin:cornell", "-r", row["resolution"].dump()});
        EXPECT_EQ(row["occupied"], alone["occupied"]) << row;
        EXPECT_EQ(row["triangles"], alone["triangles"]) << row;
    }
#ifdef CAIRN_SCENE_DATA
    const nlohmann::json moving =
        cairn_json({"bench", "check", "--scene", CAIRN_SCENE_DATA "/gltf/CesiumMan.glb", "--resolutions",
                    "32", "-o", folder.path().string()})["measurements"];
    ASSERT_EQ(moving.size(), 2U);
    EXPECT_GT(moving[1]["animation_seconds"], 0.0);
    EXPECT_EQ(moving[1]["outcome"], "same");
#endif
}

TEST(BenchLevels, ErrorsFallWithThePixelError) {
    const ScratchFolder folder;
    const nlohmann::json rows =
        rows_of("levels", "24", "builtin:cornell", folder,
                "scene,size,distance,level_of_detail,pixel_error,rmse,bricks,kib_a_brick,mib,first_cpu_ms,"
                "frame_cpu_ms,driver,threads");
    ASSERT_EQ(rows.size(), 2U * 3U * 4U);
    for (const nlohmann::json& row : rows) {
        EXPECT_EQ(row["size"], "24x24") << row;
        EXPECT_GT(row["rmse"], 0.0) << row;
        EXPECT_LT(row["rmse"], 60.0) << row;
        EXPECT_GT(row["bricks"], 0) << row;
        EXPECT_GT(row["frame_cpu_ms"], 0.0) << row;
    }
    EXPECT_EQ(rows[0]["level_of_detail"], "nearest");
    EXPECT_EQ(rows[4]["level_of_detail"], "nearest+mips");
    EXPECT_EQ(rows[0]["rmse"], rows[4]["rmse"]) << "mips change nothing where they are not read";
    EXPECT_LT(rows[0]["kib_a_brick"], rows[4]["kib_a_brick"]);
    EXPECT_LT(rows[0]["rmse"], rows[3]["rmse"]) << "voxels of half a pixel, and of four";
}

#ifdef CAIRN_SCENE_DATA
TEST(BenchMoving, VoxelizesEveryFrameExactly) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of("moving", "16", CAIRN_SCENE_DATA "/gltf/CesiumMan.glb", folder);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0]["scene"], "CesiumMan.glb");
    EXPECT_GT(rows[0]["frames"], 10);
    EXPECT_GT(rows[0]["checked_frames"], 1);
    EXPECT_EQ(rows[0]["missing"], 0);
    EXPECT_EQ(rows[0]["extra"], 0);
    for (const char* time : {"deform_ms", "voxelize_ms", "ours_ms", "embree_low_ms", "embree_medium_ms"})
        EXPECT_GT(rows[0][time], 0.0) << time;
}
#endif

TEST(BenchMoving, RefusesASceneThatDoesNotMove) {
    const ScratchFolder folder;
    const Answer answer =
        cairn({"bench", "moving", "--scene", "builtin:cornell", "-o", folder.path().string(), "--quiet"});
    EXPECT_EQ(answer.code, 2) << answer;
    EXPECT_NE(answer.err.find("has no animation"), std::string::npos) << answer;
}

TEST(BenchRegions, OneRegionIsMarkedWithItsIndexAndWithout) {
    const ScratchFolder folder;
    const nlohmann::json rows = rows_of(
        "region-deep", "64", "builtin:knot", folder,
        "scene,triangles,inside,level,occupied,region_ms,region_cpu_ms,index_cpu_ms,without_index_ms,driver");
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_GT(rows[0]["triangles"], 50000);
    EXPECT_NEAR(rows[0]["inside"].get<double>(), 2000.0, 500.0);
    EXPECT_GT(rows[0]["occupied"], 0);
    EXPECT_GT(rows[0]["region_ms"], 0.0);
}

TEST(BenchRegions, AGridIsTheSameInRegionsOfAnySize) {
    const ScratchFolder folder;
    const nlohmann::json rows =
        rows_of("region-sizes", "256", "builtin:cornell", folder,
                "scene,resolution,region_mib,regions,triangles,occupied,all_ms,marking_ms,cpu_ms,driver");
    ASSERT_EQ(rows.size(), 7U);
    for (const nlohmann::json& row : rows) {
        EXPECT_EQ(row["occupied"], rows[0]["occupied"]) << row;
        EXPECT_LE(row["regions"], rows[0]["regions"]) << row;
    }
}

TEST(BenchUsage, HasHelpThatFitsATerminal) {
    const Answer answer = cairn({"bench", "--help"});
    EXPECT_EQ(answer.code, 0) << answer;
    for (const char* word : {"voxelize", "render", "--scenes", "--resolutions", "--truth-cache", "--json"})
        EXPECT_NE(answer.out.find(word), std::string::npos) << word;
    for (const std::string& line : lines_of(answer.out))
        EXPECT_LE(line.size(), 100U) << line;
}

TEST(BenchUsage, NamesTheChartsThatThereAre) {
    const Answer answer = cairn({"bench", "shadows"});
    EXPECT_EQ(answer.code, 2) << answer;
    EXPECT_NE(answer.err.find("choose one of: voxelize, embree, render"), std::string::npos) << answer;
    for (const char* sizes : {"0", "64.5", "100000", "x"})
        EXPECT_EQ(cairn({"bench", "voxelize", "--resolutions", sizes}).code, 2) << sizes;
}

TEST(BenchCommand, OptionsOfVoxelsChangeWhatAChartMeasures) {
    const ScratchFolder folder;
    const auto produced = [&](const std::vector<std::string>& options) {
        std::vector<std::string> words = {
            "bench",  "production", "--scene", "builtin:cornell",     "--resolutions", "32",
            "--runs", "1",          "-o",      folder.path().string()};
        words.insert(words.end(), options.begin(), options.end());
        return cairn_json(words);
    };
    const auto usual = produced({});
    EXPECT_FALSE(usual.contains("voxel_options"));
    const auto small = produced({"--brick-m", "8", "--traversal", "restart"});
    EXPECT_EQ(small["voxel_options"]["brick-m"], "8");
    EXPECT_EQ(small["voxel_options"]["traversal"], "restart");
    EXPECT_GT(small["measurements"][0]["bricks_produced"], usual["measurements"][0]["bricks_produced"]);
}

/// Runs the chart "production" at a tiny size, not quietly.
Answer production_of(const std::vector<std::string>& options, const ScratchFolder& folder) {
    std::vector<std::string> words = {"bench", "production", "--resolutions",       "16", "--runs",
                                      "1",     "-o",         folder.path().string()};
    words.insert(words.end(), options.begin(), options.end());
    return cairn(words);
}

TEST(BenchCommand, OptionsOfVolumesAreRefusedIfNoSceneIsAVolume) {
    const ScratchFolder folder;
    for (const char* chart : {"production", "exploration", "resolution"}) {
        for (const char* option : {"--steps-per-voxel", "--gradient-threshold"}) {
            const Answer answer = cairn({"bench", chart, "--scene", "builtin:cornell", "--scene",
                                         "builtin:sponge", option, "1", "-o", folder.path().string()});
            EXPECT_EQ(answer.code, 2) << answer;
            EXPECT_NE(answer.err.find(option), std::string::npos) << answer;
            EXPECT_NE(answer.err.find("none of the chart's scenes is a volume"), std::string::npos) << answer;
        }
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

TEST(BenchCommand, OptionsOfVolumesComeWithANoteOfTheSurfacesBesideThem) {
    const ScratchFolder folder;
    const Answer mixed = production_of(
        {"--scene", "builtin:cornell", "--scene", "builtin:hollow-sphere", "--steps-per-voxel", "2"}, folder);
    EXPECT_EQ(mixed.code, 0) << mixed;
    EXPECT_NE(mixed.err.find("--steps-per-voxel changes nothing of builtin:cornell"), std::string::npos)
        << mixed;
    EXPECT_EQ(mixed.err.find("builtin:hollow-sphere"), std::string::npos) << mixed;
    const Answer surface = production_of({"--scene", "builtin:cornell"}, folder);
    EXPECT_EQ(surface.code, 0) << surface;
    EXPECT_EQ(surface.err.find("no volume"), std::string::npos) << surface;
}

TEST(BenchCommand, OptionsOfVoxelsThatAChartVariesItselfAreRefused) {
    const std::vector<std::vector<std::string>> refused = {{"structure", "--tree-n", "2"},
                                                           {"structure", "--traversal", "restart"},
                                                           {"render", "--brick-m", "8"},
                                                           {"resolution", "--tree-n", "2"},
                                                           {"voxelize", "--traversal", "restart"},
                                                           {"embree", "--frame-budget", "5"},
                                                           {"moving-shadow", "--tile-queries", "blocks"}};
    for (const std::vector<std::string>& words : refused) {
        const Answer answer = cairn({"bench", words[0], words[1], words[2]});
        EXPECT_EQ(answer.code, 2) << answer;
        EXPECT_NE(answer.err.find(words[1]), std::string::npos) << answer;
        EXPECT_NE(answer.err.find(words[0]), std::string::npos) << answer;
    }
}

}  // namespace
}  // namespace cairn::test

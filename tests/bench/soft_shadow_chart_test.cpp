// `cairn bench soft-shadow-map`, run as a user runs it, at tiny sizes.
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

TEST(BenchSoftShadowMap, WritesEveryStudyWithItsErrorAndItsTime) {
    const ScratchFolder folder;
    const nlohmann::json rows =
        cairn_json({"bench", "soft-shadow-map", "--scene", "builtin:square", "--resolutions", "8,13",
                    "--runs", "1", "-o", folder.path().string()})["measurements"];
    std::map<std::string, std::set<double>> parameters;
    for (const nlohmann::json& row : rows) {
        parameters[row["study"]].insert(row["parameter"].get<double>());
        EXPECT_EQ(row["occluder"], "square") << row;
        EXPECT_GE(row["milliseconds"], 0.0) << row;
        EXPECT_LE(row["error"], row["rmse"]) << row;
        EXPECT_LE(row["rmse"], row["max_error"]) << row;
        EXPECT_LE(row["wrong_points"], row["points"]) << row;
        EXPECT_LE(row["points"], 13 * 13) << row;
        // Fitted windows cut an aligned square in patches without a rest.
        if (row["window"] == "fitted" && row["format"] == "fp32") {
            EXPECT_LT(row["error"], 0.004) << row;
        }
        if (row["study"] == "lateral") {
            EXPECT_EQ(row["occluder_size"], 13) << row;
            EXPECT_GT(row["micro_patches"], 0) << row;
            EXPECT_GT(row["fragments"], row["micro_patches"]) << row;
        }
    }
    EXPECT_EQ(parameters["resolution"], (std::set<double>{8.0, 13.0}));
    EXPECT_EQ(parameters["format"], (std::set<double>{8.0, 13.0}));
    for (const char* study : {"light-size", "lateral", "vertical", "polygons"})
        EXPECT_GE(parameters[study].size(), 5U) << study;

    std::istringstream text(read_text(folder.file("soft_shadow_map.csv")));
    std::size_t lines = 0;
    for (std::string line; std::getline(text, line);)
        ++lines;
    EXPECT_EQ(lines, rows.size() + 1);
#ifdef CAIRN_HAS_GNUPLOT
    EXPECT_TRUE(read_text(folder.file("soft_shadow_map.png")).starts_with("\x89PNG"));
#endif
}

TEST(BenchSoftShadowMap, RefusesAnOccluderThatIsNotThere) {
    const ScratchFolder folder;
    const Answer answer =
        cairn({"bench", "soft-shadow-map", "--scene", "builtin:nothing", "-o", folder.path().string()});
    EXPECT_EQ(answer.code, 2) << answer;
}

}  // namespace
}  // namespace cairn::test

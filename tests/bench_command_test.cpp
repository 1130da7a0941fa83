// `cairn bench`, run as a user runs it, at tiny sizes.
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/command.h"
#include "tests/scratch_folder.h"

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

TEST(BenchRender, WritesATable) {
    const ScratchFolder folder;
    const nlohmann::json answer =
        cairn_json({"bench", "render", "--scene", "builtin:cornell", "--resolutions", "32", "--runs", "1",
                    "-o", folder.path().string()});
    EXPECT_EQ(lines_of(read_text(folder.file("render.csv"))).size(), 2U);
    EXPECT_GT(answer["measurements"][0]["converged_ms"], 0.0);
}

TEST(BenchUsage, HasHelpThatFitsATerminal) {
    const Answer answer = cairn({"bench", "--help"});
    EXPECT_EQ(answer.code, 0) << answer;
    for (const char* word : {"voxelize", "render", "--scenes", "--resolutions", "--json"})
        EXPECT_NE(answer.out.find(word), std::string::npos) << word;
    for (const std::string& line : lines_of(answer.out))
        EXPECT_LE(line.size(), 100U) << line;
}

TEST(BenchUsage, NamesTheChartsThatThereAre) {
    const Answer answer = cairn({"bench", "shadows"});
    EXPECT_EQ(answer.code, 2) << answer;
    EXPECT_NE(answer.err.find("choose one of: voxelize, render"), std::string::npos) << answer;
    for (const char* sizes : {"0", "64.5", "100000", "x"})
        EXPECT_EQ(cairn({"bench", "voxelize", "--resolutions", sizes}).code, 2) << sizes;
}

}  // namespace
}  // namespace cairn::test

// The tables of the charts, and the scripts of their pictures, from the CSVs of bench/results/.

#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "bench/plots/panel.h"
#include "bench/plots/render_plot.h"
#include "bench/plots/shadow_plot.h"
#include "bench/plots/soft_shadow_plot.h"
#include "bench/plots/table.h"
#include "bench/plots/voxelize_plot.h"

namespace cairn::bench {
namespace {

const Table small{
    {"scene", "ms", "runs", "error"},
    {{std::string("knot"), 2.5, std::int64_t(7), Cell{}}, {std::string("tree"), std::int64_t(3)}},
    "speeds"};

template <typename Read>
std::string error_of(const Read& read) {
    try {
        (void)read();
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::internal);
        return error.what();
    }
    return "none";
}

TEST(Table, GivesCellsByRowAndColumn) {
    const std::vector<Row> rows = rows_of(small);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].text("scene"), "knot");
    EXPECT_EQ(rows[0].number("ms"), 2.5);
    EXPECT_EQ(rows[0].whole("runs"), 7);
    EXPECT_TRUE(rows[0].is_empty("error"));
    EXPECT_EQ(rows[1].number("ms"), 3.0) << "a whole number is a number too";
}

TEST(Table, RefusesAColumnThatIsMisspelt) {
    EXPECT_EQ(error_of([] { return small.at(0, "milliseconds"); }),
              "speeds: there is no column \"milliseconds\" among scene, ms, runs, error");
    EXPECT_EQ(error_of([] { return rows_of(small)[0].text("Scene"); }),
              "speeds: there is no column \"Scene\" among scene, ms, runs, error");
}

TEST(Table, RefusesRowsThatAreShortOrNotThere) {
    EXPECT_EQ(error_of([] { return small.at(1, "runs"); }),
              "speeds: row 1 of 2 has no \"runs\" of scene, ms, runs, error");
    EXPECT_EQ(error_of([] { return small.at(2, "scene"); }),
              "speeds: row 2 of 2 has no \"scene\" of scene, ms, runs, error");
}

TEST(Table, RefusesCellsOfAnotherType) {
    const Row row = rows_of(small)[0];
    EXPECT_EQ(error_of([&] { return row.text("ms"); }), "speeds: a cell of \"ms\" is no text");
    EXPECT_EQ(error_of([&] { return row.whole("ms"); }), "speeds: a cell of \"ms\" is no whole number");
    EXPECT_EQ(error_of([&] { return row.number("error"); }), "speeds: a cell of \"error\" is no number");
}

TEST(Plots, RefuseATableWhoseColumnIsMisspelt) {
    using Plot = std::string (*)(const Table&, const std::filesystem::path&);
    for (const Plot plot :
         {Plot(render_plot), Plot(shadow_plot), Plot(soft_shadow_plot), Plot(voxelize_plot)}) {
        const std::string text = error_of([&] { return plot(small, "picture.png"); });
        EXPECT_TRUE(text.starts_with("speeds: there is no column \"")) << text;
        EXPECT_TRUE(text.ends_with(" among scene, ms, runs, error")) << text;
    }
}

TEST(Panels, TellWhatBeatsAnother) {
    EXPECT_TRUE(beats({1.0, 0.1}, {2.0, 0.1}));
    EXPECT_TRUE(beats({1.0, 0.1}, {1.0, 0.2}));
    EXPECT_FALSE(beats({1.0, 0.1}, {1.0, 0.1})) << "the same";
    EXPECT_FALSE(beats({1.0, 0.2}, {2.0, 0.1})) << "faster, but further from the truth";
}

/// The cells of a line of a CSV.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells{""};
    bool is_quoted = false;
    for (const char c : line) {
        if (c == '"') {
            is_quoted = !is_quoted;
        } else if (c == ',' && !is_quoted) {
            cells.emplace_back();
        } else {
            cells.back() += c;
        }
    }
    return cells;
}

Cell cell_of(const std::string& text) {
    if (text.empty()) return {};
    char* end = nullptr;
    const long long whole = std::strtoll(text.c_str(), &end, 10);
    if (*end == '\0') return std::int64_t(whole);
    const double number = std::strtod(text.c_str(), &end);
    return *end == '\0' ? Cell(number) : Cell(text);
}

/// A table of bench/results/.
Table result(const std::string& name) {
    std::ifstream stream(std::string(CAIRN_BENCH_RESULTS) + "/" + name + ".csv");
    std::string line;
    std::getline(stream, line);
    Table table{cells_of(line), {}, name};
    while (std::getline(stream, line)) {
        std::vector<Cell>& row = table.rows.emplace_back();
        for (const std::string& text : cells_of(line))
            row.push_back(cell_of(text));
    }
    EXPECT_GT(table.rows.size(), 10U) << name << ".csv was not read";
    return table;
}

std::set<std::string> texts_in(const Table& table, const char* column) {
    std::set<std::string> texts;
    for (const Row& row : rows_of(table))
        texts.insert(row.text(column));
    return texts;
}

int count(const std::string& text, const std::string& what) {
    int found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++found;
    return found;
}

void expect_all(const std::string& script, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
        EXPECT_NE(script.find(part), std::string::npos) << "not in the script: " << part;
}

TEST(Plots, VoxelizeHasAPanelForEachSceneAndALineForEachMethod) {
    const Table table = result("voxelize");
    const std::string script = voxelize_plot(table, "v.png");
    const std::set<std::string> scenes = texts_in(table, "scene");
    EXPECT_EQ(count(script, "\nplot $d"), int(scenes.size()));
    for (const std::string& scene : scenes)
        expect_all(script, {"set title \"" + scene + "\""});
    for (const std::string& method : texts_in(table, "method"))
        EXPECT_EQ(script.find(" \"" + method + "\" at screen") == std::string::npos, method == "pyramid")
            << method;
    expect_all(script, {"set output \"v.png\"", "llvmpipe", "\"exact\"", "\"finds none\""});
    EXPECT_EQ(script.find("none: CPU"), std::string::npos) << "the driver is the GPU's";
}

TEST(Plots, RenderHasTwoPanelsForEachSceneAndALineForEachSeries) {
    const Table table = result("render");
    const std::string script = render_plot(table, "r.png");
    EXPECT_EQ(count(script, "\nplot $front"), 2 * int(texts_in(table, "scene").size()));
    expect_all(script,
               {"title \"N 4, M 16\"", "title \"N 8, M 16\"", "title \"restart\"", "title \"stackless\"",
                "title \"pool of 32 MiB\"", "title \"pool of 8 MiB\"", "RMSE of sRGB", "silhouette"});
}

TEST(Plots, ShadowHasFourPanelsForEachSceneAndALineForEachMethod) {
    const Table table = result("shadow");
    const std::string script = shadow_plot(table, "s.png");
    const std::set<std::string> scenes = texts_in(table, "scene");
    EXPECT_EQ(count(script, "\nplot $front"), 4 * int(scenes.size()));
    for (const std::string& scene : scenes)
        expect_all(script, {scene + ": hard light, on the ground", scene + ": soft light, on all"});
    for (const Row& row : rows_of(table))
        expect_all(script, {"title \"" + row.text("method") + ": " + row.text("varied") + "\""});
}

TEST(Plots, SoftShadowsHaveFourPanelsForEachOccluderAndFourOfTimes) {
    const Table table = result("soft_shadow_map");
    const std::string script = soft_shadow_plot(table, "m.png");
    const std::set<std::string> occluders = texts_in(table, "occluder");
    EXPECT_EQ(count(script, "\nplot $s"), 4 * int(occluders.size()) + 4);
    for (const std::string& occluder : occluders)
        expect_all(script, {occluder + ": size of the occluder map", occluder + ": width of the light",
                            occluder + ": lateral position", occluder + ": vertical position"});
    expect_all(script, {"time over triangles", "time over the occluder map", "time over the light",
                        "what sums are kept in", "title \"one pass\"", "title \"two passes\"",
                        "title \"fp16-batches\""});
}

}  // namespace
}  // namespace cairn::bench

// The charts of shadows, at tiny sizes: every method takes part, and its error is within bounds.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "bench/charts/chart.h"
#include "bench/trials/shadow_runs.h"
#include "bench/trials/shadow_scene.h"
#include "reference/shadow_truth.h"
#include "renderer/mesh/mesh_raster.h"
#include "shaders/interop/mesh.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scratch_folder.h"

namespace cairn::bench {
namespace {

/// A row of a table, read by names of columns.
class Row {
public:
    Row(const Table& table, std::size_t index) : table_(table), cells_(table.rows[index]) {}
    [[nodiscard]] const Cell& operator[](const std::string& column) const {
        for (std::size_t i = 0; i < table_.columns.size(); ++i)
            if (table_.columns[i] == column) return cells_.at(i);
        throw std::out_of_range(column);
    }
    [[nodiscard]] bool has(const std::string& column) const { return (*this)[column].index() != 0; }
    [[nodiscard]] std::string text(const std::string& column) const {
        return std::get<std::string>((*this)[column]);
    }
    [[nodiscard]] std::int64_t whole(const std::string& column) const {
        return std::get<std::int64_t>((*this)[column]);
    }
    [[nodiscard]] double number(const std::string& column) const { return std::get<double>((*this)[column]); }
    [[nodiscard]] std::string shown() const {
        std::ostringstream out;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            out << table_.columns[i] << '=';
            std::visit(
                [&](const auto& value) {
                    if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
                        out << value;
                },
                cells_[i]);
            out << ' ';
        }
        return out.str();
    }

private:
    const Table& table_;
    const std::vector<Cell>& cells_;
};

std::vector<Row> rows_of(const Chart& chart) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < chart.table.rows.size(); ++i) {
        EXPECT_EQ(chart.table.rows[i].size(), chart.table.columns.size());
        rows.emplace_back(chart.table, i);
    }
    return rows;
}

bool has_note(const Chart& chart, const std::string& part) {
    for (const std::string& note : chart.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

class ShadowChart : public test::GlTest {};

void expect_every_method_where_it_applies(const Chart& chart) {
    std::map<std::string, std::set<std::string>> methods;
    for (const Row& row : rows_of(chart)) {
        methods[row.text("light") + " " + row.text("receivers")].insert(row.text("method"));
        EXPECT_GT(row.number("ms"), 0.0) << row.shown();
        EXPECT_GT(row.whole("pixels"), 100) << row.shown();
        EXPECT_LE(row.number("rmse"), 1.0) << row.shown();
    }
    const std::set<std::string> hard = {"voxel-rays", "pyramid", "pcf", "embree-single", "embree-packets"};
    const std::set<std::string> soft = {"voxel-rays", "voxel-cones",   "pyramid",       "pcf",
                                        "pcss",       "embree-single", "embree-packets"};
    std::set<std::string> with_maps = soft;
    with_maps.insert("soft-shadow-map");
    EXPECT_EQ(methods["hard ground"], hard);
    EXPECT_EQ(methods["hard all"], hard);
    EXPECT_EQ(methods["soft all"], soft);
    EXPECT_EQ(methods["soft ground"], with_maps);
}

void expect_embree_to_come_nearer_with_samples(const Chart& chart) {
    std::map<std::string, std::map<std::int64_t, double>> errors;
    for (const Row& row : rows_of(chart)) {
        if (!row.has("samples")) continue;
        if (row.text("light") == "hard") {
            EXPECT_EQ(row.number("hard_disagreement"), 0.0) << row.shown();
        } else {
            errors[row.text("method") + " " + row.text("receivers")][row.whole("samples")] =
                row.number("rmse");
        }
    }
    ASSERT_EQ(errors.size(), 4U);
    for (const auto& [line, by_samples] : errors) {
        double before = 1.0;
        for (const auto& [samples, rmse] : by_samples) {
            EXPECT_LT(rmse, before) << line << ", " << samples << " samples";
            before = rmse;
        }
        EXPECT_LT(before, 0.01) << line;
    }
}

// With wrong windows, pixels in another order or a light elsewhere, errors would be like those without a
// shadow.
void expect_every_method_to_show_the_shadow(const Chart& chart) {
    std::map<std::string, double> least;
    for (const Row& row : rows_of(chart)) {
        const std::string line = row.text("light") + " " + row.text("receivers") + " " + row.text("method");
        const double error = row.number(row.text("light") == "hard" ? "hard_disagreement" : "rmse");
        least.try_emplace(line, 1.0);
        least[line] = std::min(least[line], error);
    }
    for (const auto& [line, error] : least)
        EXPECT_LT(error, line.ends_with("pcf") ? 0.25 : 0.15) << line;  // edges without a penumbra
}

void expect_ours_beside_embree_at_the_same_error(const Chart& chart) {
    int fastest = 0;
    for (const Row& row : rows_of(chart)) {
        EXPECT_EQ(row.has("embree_ms"), row.has("embree_over")) << row.shown();
        if (row.has("embree_ms")) {
            EXPECT_EQ(row.text("light"), "soft");
            EXPECT_NEAR(row.number("embree_over") * row.number("ms"), row.number("embree_ms"),
                        1e-6 * row.number("embree_ms"));
        }
        if (row.text("goal") != "fastest") continue;
        ++fastest;
        EXPECT_LE(row.number("rmse"), 0.03) << row.shown();
    }
    EXPECT_GE(fastest, 2);  // Embree's rows, on the ground and on all
    EXPECT_TRUE(has_note(chart, "RMSE 0.03 at most"));
}

// This is one test, because the chart takes seconds. Lines that take longer than several budgets are cut
// short, so the budget leaves room for a loaded machine: a line that is cut ends at voxels too coarse for the
// bounds below.
TEST_F(ShadowChart, ComparesEveryMethodWithEmbree) {
    const test::ScratchFolder folder;
    ChartOptions options;
    options.folder = folder.path();
    options.scenes = {"builtin:spheres"};
    options.resolutions = {64};
    options.runs = 1;
    options.budget_ms = 1000.0;
    options.truth_cache = folder.path() / "truth";
    const Chart chart = chart_shadow(options);
    expect_every_method_where_it_applies(chart);
    expect_embree_to_come_nearer_with_samples(chart);
    expect_every_method_to_show_the_shadow(chart);
    expect_ours_beside_embree_at_the_same_error(chart);

    std::ifstream table(folder.path() / "shadow.csv");
    std::string head;
    std::getline(table, head);
    EXPECT_TRUE(head.starts_with("scene,light,receivers,method,varied,rays,resolution,map_size,")) << head;
    EXPECT_TRUE(head.ends_with(",driver,threads")) << head;
    EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "truth"));
#ifdef CAIRN_HAS_GNUPLOT
    EXPECT_GT(std::filesystem::file_size(folder.path() / "shadow.png"), 10000U);
    EXPECT_FALSE(has_note(chart, "no picture"));
#endif
}

TEST_F(ShadowChart, LeavesOutWhatWouldTakeTooLong) {
    const test::ScratchFolder own;
    ChartOptions options;
    options.folder = own.path();
    options.scenes = {"builtin:cornell"};
    options.resolutions = {16};
    options.runs = 1;
    options.budget_ms = 1e-3;
    const Chart chart = chart_shadow(options);
    EXPECT_TRUE(has_note(chart, "is left out"));
    std::set<std::int64_t> resolutions;
    for (const Row& row : rows_of(chart))
        if (row.text("method") == "voxel-rays" && row.text("varied") == "resolution")
            resolutions.insert(row.whole("resolution"));
    EXPECT_EQ(resolutions, std::set<std::int64_t>{128});
}

TEST_F(ShadowChart, RaysHaveThePapersFiguresBeside) {
    const test::ScratchFolder own;
    ChartOptions options;
    options.folder = own.path();
    options.scenes = {"builtin:spheres"};
    options.resolutions = {8, 128};
    options.width = 64;
    options.runs = 1;
    const Chart chart = chart_shadow_rays(options);
    std::map<std::int64_t, double> by_rays, paper_by_rays, by_resolution, paper_by_resolution;
    for (const Row& row : rows_of(chart)) {
        EXPECT_GT(row.number("ms"), 0.0) << row.shown();
        if (row.whole("table") == 2) {
            EXPECT_EQ(row.whole("resolution"), 128);
            paper_by_rays[row.whole("rays")] = row.number("paper_ms");
            if (row.whole("rays") > 1) by_rays[row.whole("rays")] = row.number("rmse");
        } else {
            paper_by_resolution[row.whole("resolution")] = row.number("paper_ms");
            by_resolution[row.whole("resolution")] = row.number("hard_disagreement");
        }
    }
    EXPECT_EQ(paper_by_rays,
              (std::map<std::int64_t, double>{
                  {1, 17}, {4, 54}, {8, 118}, {16, 236}, {32, 513}, {128, 1963}, {512, 7662}}));
    EXPECT_EQ(paper_by_resolution, (std::map<std::int64_t, double>{{8, 4}, {128, 17}}));
    EXPECT_LT(by_rays[512], by_rays[4]);
    EXPECT_LT(by_resolution[128], 0.5 * by_resolution[8]);
    EXPECT_TRUE(has_note(chart, "128 rays take"));
    EXPECT_TRUE(std::filesystem::exists(own.path() / "shadow_rays.csv"));
}

// Threads of a driver that run together share its limit of loop turns. With a budget that is right for a
// single thread, the last of many rays would be lost silently, and the shadow would be lighter.
TEST_F(ShadowChart, ManyRaysAreNoLessAccurateThanFew) {
    const ShadowScene scene("builtin:knot");
    constexpr int width = 48;
    constexpr int height = 36;
    renderer::View view = scene.view(width, height, 1);
    const scenes::NodeSelection everything(scene.scene().nodes.size(), true);
    const reference::ImageTracer tracer(scene.scene(), scene.all());
    const reference::ShadowQuestion question{scene.scene(), scene.all(), everything, view.camera,
                                             view.light,    width,       height};
    const reference::ShadowReceivers receivers = shadow_receivers(tracer, question);
    reference::AreaLightOptions sampling;
    sampling.exact_strata = 32;
    const std::vector<float> truth = soft_shares(tracer, question, receivers, sampling).shares;
    ShadowFrames ours(renderer::ShadowMethod::voxel, scene, {.tree = tree_of(512)});
    view.detail.pixel_error = always_finest;
    const auto rmse = [&](int rays) {
        view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
        return reference::shadow_error(ours.run(view).shares, truth).rmse();
    };
    const double few = rmse(64);
    EXPECT_LT(rmse(512), 1.1 * few);
}

// The tree is rasterized in several batches, whose triangles are written to one buffer in turn. If a batch
// were written while the one before is still drawn, some runs would show triangles that are not there.
TEST_F(ShadowChart, MeshesOfSeveralBatchesAreWhole) {
    const ShadowScene scene("builtin:tree");
    ASSERT_GT(scene.all().triangle_count, std::uint64_t(renderer::MeshRasterLimits().triangles));
    const scenes::NodeSelection everything(scene.scene().nodes.size(), true);
    const reference::ImageTracer tracer(scene.scene(), scene.all());
    ShadowFrames ours(renderer::ShadowMethod::voxel, scene, {.tree = tree_of(256)});
    std::map<int, std::vector<float>> before;
    for (const int width : {64, 68, 72, 76, 80, 64, 68, 72, 76, 80}) {
        const int height = width * 3 / 4;
        const renderer::View view = scene.view(width, height, 1);
        const reference::ShadowQuestion question{scene.scene(), scene.all(), everything, view.camera,
                                                 view.light,    width,       height};
        const reference::ShadowReceivers receivers = shadow_receivers(tracer, question);
        const std::vector<float> shares = ours.run(view).shares;
        int missing = 0;
        for (const std::size_t pixel : receivers.pixels)
            missing += shares[pixel] < 0.0F ? 1 : 0;
        EXPECT_LT(missing, 0.01 * double(receivers.pixels.size())) << "width " << width;
        EXPECT_LT(reference::shadow_error(shares, hard_shares(receivers)).disagreement(), 0.15)
            << "width " << width;
        const auto [known, is_new] = before.try_emplace(width, shares);
        EXPECT_TRUE(is_new || known->second == shares) << "width " << width << ", the second time";
    }
}

}  // namespace
}  // namespace cairn::bench

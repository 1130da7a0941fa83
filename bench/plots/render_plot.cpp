#include "bench/plots/render_plot.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "bench/plots/panel.h"

namespace cairn::bench {
namespace {

struct Point {
    std::string scene, varied, series;
    double pixel_error = 1.0;
    double ms = 0.0;
    std::array<double, 2> errors{};  ///< error of colours, error of the silhouette

    [[nodiscard]] TimeAndError by(std::size_t error) const { return {ms, errors[error]}; }
};

std::string series_of(const Row& row) {
    const std::string& varied = row.text("varied");
    if (varied == "shape") return fmt::format("N {}, M {}", row.whole("n"), row.whole("m"));
    if (varied == "geometry") {
        const std::string& met = row.text("geometry");
        return met == "voxel" ? "whole voxels" : met + " alone";
    }
    if (varied == "samples") return fmt::format("{} samples", row.whole("samples"));
    if (varied == "traversal") return row.text("traversal");
    return fmt::format("pool of {:g} MiB", row.number("pool_mib"));
}

class RenderPlot {
public:
    explicit RenderPlot(const Table& table) : machine_(machine_of(table)) {
        for (const Row& row : rows_of(table)) {
            const Point point{row.text("scene"), row.text("varied"),
                              series_of(row),    row.number("pixel_error"),
                              row.number("ms"),  {row.number("rmse"), row.number("silhouette")}};
            add_once(scenes_, point.scene);
            add_once(series_, point.series);
            points_.push_back(point);
        }
    }

    [[nodiscard]] std::string script(const std::filesystem::path& picture) const {
        const PanelGrid grid{.rows = int(scenes_.size()),
                             .columns = 2,
                             .width = 1400,
                             .height = 130 + 480 * int(scenes_.size()),
                             .left = 0.07,
                             .right = 0.82,
                             .column_gap = 0.07};
        std::string out = open_picture(grid, picture) + open_panels(grid);
        out += label({1, "Converged frames: time against error; down and to the left is better", 15,
                      grid.from_top(24), middle});
        out += label({2,
                      machine_.words() +
                          ". Labels: pixel error. Ring: no other is faster and nearer to the picture with "
                          "64 samples per pixel",
                      10, grid.from_top(48), middle});
        out +=
            "set logscale xy\nset format x \"%g\"\nset format y \"%g\"\nset grid lc \"#e4e4e4\" lt 1\n"
            "set border lc \"#888888\"\nset tics nomirror\nset xtics add (2, 5, 20, 50, 200, 500, 2000)\n"
            "set ytics add (0.002, 0.005, 0.02, 0.03, 0.05, 0.2, 0.3, 0.5)\n"
            "set xlabel \"milliseconds\" offset 0,0.3\n";
        for (const std::string& scene : scenes_) {
            out += panel(scene, 0);
            out += panel(scene, 1);
        }
        return out + "unset multiplot\n";
    }

private:
    static constexpr double middle = 0.45;  ///< middle of the panels, beside their key

    [[nodiscard]] bool on_front(const Point& point, std::size_t error) const {
        return std::none_of(points_.begin(), points_.end(), [&](const Point& other) {
            return other.scene == point.scene && beats(other.by(error), point.by(error));
        });
    }

    [[nodiscard]] std::string panel(const std::string& scene, std::size_t error) const {
        std::vector<Point> front;
        for (const Point& point : points_)
            if (point.scene == scene && on_front(point, error)) front.push_back(point);
        std::sort(front.begin(), front.end(), [](const Point& a, const Point& b) { return a.ms < b.ms; });
        std::string lines;
        for (const Point& point : front)
            lines += fmt::format("{:.6g} {:.6g}\n", point.ms, point.errors[error]);
        std::string blocks = data_block("$front", lines);
        lines.clear();
        // If several pixel errors take the same levels, the first has the label.
        double labelled = -1.0;
        for (const Point& point : points_) {
            if (point.scene != scene || point.series != series_.front() || point.errors[error] == labelled)
                continue;
            labelled = point.errors[error];
            lines += fmt::format("{:.6g} {:.6g} {:.3g}\n", point.ms, labelled, point.pixel_error);
        }
        blocks += data_block("$labels", lines);
        std::string plots = "plot $front using 1:2 with lines lw 4 lc \"#dddddd\" title \"front\"";
        for (std::size_t s = 0; s < series_.size(); ++s) {
            lines.clear();
            bool is_line = false;
            bool has_samples = false;
            bool has_geometry = false;
            for (const Point& point : points_) {
                if (point.scene != scene || point.series != series_[s]) continue;
                lines += fmt::format("{:.6g} {:.6g}\n", point.ms, point.errors[error]);
                has_samples = point.varied == "samples";
                has_geometry = point.varied == "geometry";
                is_line = point.varied == "shape" || has_geometry || has_samples;
            }
            blocks += data_block(fmt::format("$s{}", s), lines);
            const PlotStyle& style = plot_styles[s % plot_styles.size()];
            plots += fmt::format(", $s{} using 1:2 with {} pt {} ps {} lw 1.4{} lc \"{}\" title {}", s,
                                 is_line ? "linespoints" : "points", is_line ? style.point : 2,
                                 is_line ? 1.1 : 1.8,
                                 has_samples    ? " dt 2"
                                 : has_geometry ? " dt 3"
                                                : "",
                                 style.color, quoted(series_[s]));
        }
        plots +=
            ", $labels using 1:2:3 with labels offset 0,-1 font \"sans,9\" notitle, $front using 1:2 "
            "with points pt 6 ps 2.2 lw 1.4 lc \"#000000\" notitle\n";
        std::string out = blocks;
        out += fmt::format("set title {} offset 0,-0.5\nset ylabel {} offset 1,0\n", quoted(scene),
                           quoted(error == 0 ? "RMSE of sRGB, 1 = white" : "silhouette: wrong area / area"));
        out += error == 0 ? "unset key\n"
                          : "set key at graph 1.02,1 left top vertical Left reverse samplen 1.5 "
                            "font \"sans,10\"\n";
        out += ranges_of(scene, error);
        return out + plots + "unset label\n";
    }

    [[nodiscard]] std::string ranges_of(const std::string& scene, std::size_t error) const {
        constexpr double margin = 1.4;
        std::array<double, 4> ends = {1e30, 0.0, 1e30, 0.0};
        for (const Point& point : points_) {
            if (point.scene != scene) continue;
            ends = {std::min(ends[0], point.ms), std::max(ends[1], point.ms),
                    std::min(ends[2], point.errors[error]), std::max(ends[3], point.errors[error])};
        }
        return axis_ranges(ends[0] / margin, ends[1] * margin, std::max(ends[2], 1e-6) / margin,
                           std::max(ends[3], 1e-6) * margin);
    }

    std::vector<Point> points_;
    std::vector<std::string> scenes_, series_;
    Machine machine_;
};

}  // namespace

std::string render_plot(const Table& table, const std::filesystem::path& picture) {
    return RenderPlot(table).script(picture);
}

}  // namespace cairn::bench

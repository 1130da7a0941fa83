#include "bench/plots/voxelize_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/plots/panel.h"

namespace cairn::bench {
namespace {

struct Point {
    std::string scene;
    int resolution = 0;
    std::string method;
    double ms = 0.0;
    double error = 0.0;
    bool has_voxels = false;

    [[nodiscard]] TimeAndError measured() const { return {ms, error}; }
};

class VoxelizePlot {
public:
    explicit VoxelizePlot(const Table& table) {
        for (const Row& row : rows_of(table)) {
            Point point{row.text("scene"), int(row.whole("resolution")), row.text("method"),
                        row.number("ms")};
            if (point.method == "pyramid") continue;
            if (!row.is_empty("error")) {
                point.error = row.number("error");
                point.has_voxels = true;
            }
            add_once(scenes_, point.scene);
            add_once(methods_, point.method);
            add_once(resolutions_, point.resolution);
            points_.push_back(point);
            // The driver of contenders on the CPU is "none: CPU".
            const std::string& driver = row.text("driver");
            if (driver.find(':') == std::string::npos || machine_.driver.empty()) machine_.driver = driver;
            machine_.threads = row.whole("threads");
        }
        std::sort(resolutions_.begin(), resolutions_.end());
        for (const std::string& method : methods_) {
            const bool exact = std::all_of(points_.begin(), points_.end(), [&](const Point& point) {
                return point.method != method || (point.has_voxels && point.error == 0.0);
            });
            if (exact) exact_.push_back(method);
        }
        set_scale();
    }

    [[nodiscard]] std::string script(const std::filesystem::path& picture) const {
        const int columns = scenes_.size() <= 1 ? 1 : scenes_.size() <= 4 ? 2 : 3;
        const int rows = (int(scenes_.size()) + columns - 1) / columns;
        const PanelGrid grid{.rows = rows,
                             .columns = columns,
                             .width = std::max(120 + 560 * columns, 1200),
                             .height = 230 + 440 * rows,
                             .left = 0.085,
                             .right = 0.985,
                             .foot = 140,
                             .row_gap = 66,
                             .column_gap = 0.03};
        std::string out = open_picture(grid, picture) + data() + open_panels(grid);
        out += label({1000, "Voxelization: time against error; down and to the left is better", 15,
                      grid.from_top(24)});
        out += label({1001, machine_.words(), 10, grid.from_top(46), 0.5, "#555555"});
        out += axes();
        out += legend(grid);
        for (std::size_t i = 0; i < scenes_.size(); ++i)
            out += panel(int(i), columns);
        return out + "unset multiplot\n";
    }

private:
    [[nodiscard]] static PlotStyle style_of(std::size_t method) {
        return plot_styles[1 + method % (plot_styles.size() - 1)];  // black is for the rings
    }

    /// Sets the vertical scale: powers of ten of the error, lanes below them for exact methods, and a lane
    /// above them for methods without voxels.
    void set_scale() {
        double least = std::numeric_limits<double>::infinity();
        double most = 0.0;
        for (const Point& point : points_) {
            if (!point.has_voxels || point.error == 0.0) continue;
            least = std::min(least, point.error);
            most = std::max(most, point.error);
        }
        if (most == 0.0) least = most = 0.1;
        bottom_ = int(std::floor(std::log10(least)));
        top_ = std::max(int(std::ceil(std::log10(most))), bottom_ + 1);
        lane_ = std::max(double(top_ - bottom_) / 14.0, 0.12);
    }
    [[nodiscard]] double exact_height(const std::string& method) const {
        const auto place = std::find(exact_.begin(), exact_.end(), method) - exact_.begin();
        return bottom_ - lane_ * (1.2 + double(place));
    }
    [[nodiscard]] double lowest() const { return bottom_ - lane_ * (2.0 + double(exact_.size())); }
    [[nodiscard]] double exact_top() const { return bottom_ - 0.4 * lane_; }
    [[nodiscard]] double highest() const { return top_ + 2.0 * lane_; }
    [[nodiscard]] double height(const Point& point) const {
        if (!point.has_voxels) return top_ + lane_;
        return point.error > 0.0 ? std::log10(point.error) : exact_height(point.method);
    }

    [[nodiscard]] bool on_front(const Point& point) const {
        if (!point.has_voxels) return false;
        return std::none_of(points_.begin(), points_.end(), [&](const Point& other) {
            return other.has_voxels && other.scene == point.scene && other.resolution == point.resolution &&
                   beats(other.measured(), point.measured());
        });
    }

    [[nodiscard]] double size_of(int resolution) const {
        const auto place =
            std::find(resolutions_.begin(), resolutions_.end(), resolution) - resolutions_.begin();
        return 0.8 + 0.35 * double(place);
    }

    /// A data block per scene and method, and one per front of a scene: x, y, size of the point.
    [[nodiscard]] std::string data() const {
        std::string out;
        for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
            std::string front;
            for (std::size_t method = 0; method < methods_.size(); ++method) {
                std::string lines;
                for (const Point& p : points_) {
                    if (p.scene != scenes_[scene] || p.method != methods_[method]) continue;
                    const std::string line =
                        fmt::format("{:.6g} {:.6g} {:.3g}\n", p.ms, height(p), size_of(p.resolution));
                    lines += line;
                    if (on_front(p)) front += line;
                }
                out += data_block(fmt::format("$d{}_{}", scene, method), lines);
            }
            out += data_block(fmt::format("$front{}", scene), front);
        }
        return out;
    }

    /// The ticks of the vertical axis. @param named  with labels, as in the panels on the left.
    [[nodiscard]] std::string heights(bool named) const {
        std::string ticks;
        const auto add = [&](const std::string& name, double at) {
            ticks += fmt::format("{}\"{}\" {:.6g}", ticks.empty() ? "" : ", ", named ? name : "", at);
        };
        for (int power = bottom_; power <= top_; ++power)
            add(fmt::format("{:g} %%", std::pow(10.0, power + 2)), power);
        add("exact", bottom_ - lane_ * (1.2 + 0.5 * std::max(double(exact_.size()) - 1.0, 0.0)));
        add("finds none", top_ + lane_);
        return "set ytics (" + ticks + ")\n";
    }

    [[nodiscard]] std::string axes() const {
        double fastest = points_.front().ms;
        double slowest = fastest;
        for (const Point& p : points_) {
            fastest = std::min(fastest, p.ms);
            slowest = std::max(slowest, p.ms);
        }
        std::string out =
            "set logscale x\nset format x \"%g\"\nunset key\nset grid x y lc \"#e4e4e4\" lt 1\n"
            "set border lc \"#888888\"\nset tics textcolor \"#333333\" nomirror\n";
        out += axis_ranges(fastest / 1.6, slowest * 1.6, lowest(), highest());
        out += fmt::format(
            "set object 1 rectangle from graph 0,first {:.6g} to graph 1,first {:.6g} "
            "fc \"#e8f4ea\" fs solid noborder behind\n",
            lowest(), exact_top());
        out += fmt::format(
            "set object 2 rectangle from graph 0,first {:.6g} to graph 1,first {:.6g} "
            "fc \"#f2f2f2\" fs solid noborder behind\n",
            top_ + 0.3 * lane_, highest());
        return out;
    }

    /// The key below the panels, drawn by hand, because gnuplot's key belongs to one panel.
    [[nodiscard]] std::string legend(const PanelGrid& grid) const {
        std::string out;
        const double step = 0.96 / double(std::max<std::size_t>(methods_.size(), 1));
        for (std::size_t method = 0; method < methods_.size(); ++method) {
            const PlotStyle style = style_of(method);
            out += fmt::format(
                "set label {} {} at screen {:.4f},{:.4f} left point pt {} ps 1.5 lc \"{}\" "
                "offset character 1.2,0 font \"sans,11\"\n",
                1100 + method, quoted(methods_[method]), 0.03 + step * double(method), grid.from_bottom(62),
                style.point, style.color);
        }
        std::string sizes;
        for (const int resolution : resolutions_)
            sizes += fmt::format("{}{}", sizes.empty() ? "" : ", ", resolution);
        return out + label({1200,
                            fmt::format("larger points, further right along a line: {} voxels per side.   "
                                        "Black ring: no method is both faster and nearer to the truth at "
                                        "that resolution.   Error: (missing + extra) / true voxels",
                                        sizes),
                            10, grid.from_bottom(24), 0.5, "#333333"});
    }

    [[nodiscard]] std::string panel(int scene, int columns) const {
        std::string out =
            fmt::format("set title {} offset 0,-0.6 font \"sans,13\"\n", quoted(scenes_[std::size_t(scene)]));
        const bool lowest_row = scene + columns >= int(scenes_.size());
        out += fmt::format("set xlabel \"{}\" offset 0,0.4\nset ylabel \"{}\" offset 0.5,0\n",
                           lowest_row ? "milliseconds" : "", scene % columns == 0 ? "error" : "");
        out += heights(scene % columns == 0);
        out += "plot ";
        for (std::size_t method = 0; method < methods_.size(); ++method) {
            const PlotStyle style = style_of(method);
            out += fmt::format(
                "$d{0}_{1} using 1:2 with lines lw 1.2 lc \"{2}\", "
                "$d{0}_{1} using 1:2:3 with points pt {3} ps variable lc \"{2}\", ",
                scene, method, style.color, style.point);
        }
        out += fmt::format(
            "$front{} using 1:2:($3+0.75) with points pt 6 ps variable lw 1.6 lc \"#000000\"\n", scene);
        // Labels of the whole picture are drawn with the first panel.
        if (scene == 0) out += "unset label\n";
        return out;
    }

    std::vector<Point> points_;
    std::vector<std::string> scenes_, methods_, exact_;
    std::vector<int> resolutions_;
    Machine machine_;
    int bottom_ = 0, top_ = 1;
    double lane_ = 0.2;
};

}  // namespace

std::string voxelize_plot(const Table& table, const std::filesystem::path& picture) {
    return VoxelizePlot(table).script(picture);
}

}  // namespace cairn::bench

#include "bench/plots/shadow_plot.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/plots/panel.h"

namespace cairn::bench {
namespace {

struct Point {
    std::string scene, light, receivers, series, setting;
    double ms = 0.0;
    double error = 0.0;
};

struct Style {
    const char* color;
    int point;
    int dash;
};
/// Okabe and Ito's colours, which the colour-blind can distinguish. A method has one colour in all panels.
struct MethodColor {
    const char* method;
    const char* color;
};
constexpr std::array<MethodColor, 8> colors = {{{"voxel-rays", "#d55e00"},
                                                {"voxel-cones", "#a0522d"},
                                                {"pyramid", "#e69f00"},
                                                {"soft-shadow-map", "#0072b2"},
                                                {"pcf", "#888888"},
                                                {"pcss", "#009e73"},
                                                {"embree-single", "#000000"},
                                                {"embree-packets", "#cc79a7"}}};
constexpr std::array other_colors = {"#56b4e9"};
constexpr std::array points_of_lines = {7, 5, 9, 11, 13, 15};

struct Panel {
    const char* light;
    const char* receivers;
    const char* title;
};
constexpr std::array<Panel, 4> panels = {{{"hard", "ground", "hard light, on the ground"},
                                          {"hard", "all", "hard light, on all"},
                                          {"soft", "ground", "soft light, on the ground"},
                                          {"soft", "all", "soft light, on all"}}};

/// The label of a point.
std::string setting_of(const Row& row) {
    const auto whole = [&](const char* name) {
        return row.is_empty(name) ? std::string() : std::to_string(row.whole(name));
    };
    const std::string& varied = row.text("varied");
    if (varied.starts_with("resolution")) return whole("resolution") + "³";
    if (varied == "taps") return whole("kernel") + "²";
    if (varied == "format") return row.text("format");
    for (const char* name : {"rays", "samples", "map_size"})
        if (std::string value = whole(name); !value.empty()) return value;
    return {};
}

class ShadowPlot {
public:
    explicit ShadowPlot(const Table& table) : machine_(machine_of(table)) {
        for (const Row& row : rows_of(table)) {
            const std::string& light = row.text("light");
            const std::pair line(row.text("method"), row.text("varied"));
            const Point point{row.text("scene"),
                              light,
                              row.text("receivers"),
                              line.first + line.second,
                              setting_of(row),
                              row.number("ms"),
                              row.number(light == "hard" ? "hard_disagreement" : "rmse")};
            add_once(series_, line);
            add_once(scenes_, point.scene);
            points_.push_back(point);
        }
    }

    [[nodiscard]] std::string script(const std::filesystem::path& picture) const {
        const int key_rows = (int(series_.size()) + 4) / 5;
        const int foot = 70 + 24 * key_rows;
        const PanelGrid grid{.rows = int(scenes_.size()),
                             .columns = int(panels.size()),
                             .width = 2200,
                             .height = 90 + foot + 470 * int(scenes_.size()),
                             .font = 11,
                             .left = 0.035,
                             .right = 0.99,
                             .foot = foot,
                             .row_gap = 85,
                             .column_gap = 0.035};
        std::string out = open_picture(grid, picture) + open_panels(grid);
        out +=
            label({1, "Shadows: time against error; down and to the left is better", 16, grid.from_top(22)});
        out += label({2,
                      machine_.words() +
                          ". Ring: no other is faster and more accurate. A point on the bottom is exact",
                      11, grid.from_top(46)});
        out +=
            "set logscale xy\nset format x \"%g\"\nset format y \"%g\"\nset grid lc \"#e8e8e8\" lt 1\n"
            "set border lc \"#888888\"\nset tics nomirror\n"
            "set xlabel \"milliseconds\" offset 0,0.5\nunset key\n";
        for (const std::string& scene : scenes_)
            for (const Panel& panel : panels)
                out += drawn(scene, panel);
        return out + key(grid.from_bottom(foot - 55), key_rows) + "unset multiplot\n";
    }

private:
    /// The style of a line. Lines of one method differ by their points.
    [[nodiscard]] Style style_of(std::size_t series) const {
        const std::string& method = series_[series].first;
        int line = 0;
        for (std::size_t i = 0; i < series; ++i)
            line += series_[i].first == method ? 1 : 0;
        const auto known = std::find_if(colors.begin(), colors.end(),
                                        [&](const MethodColor& entry) { return method == entry.method; });
        const char* const color =
            known != colors.end() ? known->color : other_colors[series % other_colors.size()];
        return {color, points_of_lines[std::size_t(line) % points_of_lines.size()], line + 1};
    }

    [[nodiscard]] std::vector<Point> points_in(const std::string& scene, const Panel& panel) const {
        std::vector<Point> found;
        for (const Point& point : points_)
            if (point.scene == scene && point.light == panel.light && point.receivers == panel.receivers)
                found.push_back(point);
        return found;
    }

    static std::vector<Point> front_of(const std::vector<Point>& points) {
        std::vector<Point> front;
        for (const Point& point : points) {
            const bool is_beaten = std::any_of(points.begin(), points.end(), [&](const Point& other) {
                return beats({other.ms, other.error}, {point.ms, point.error});
            });
            if (!is_beaten) front.push_back(point);
        }
        std::sort(front.begin(), front.end(), [](const Point& a, const Point& b) { return a.ms < b.ms; });
        return front;
    }

    [[nodiscard]] std::string drawn(const std::string& scene, const Panel& panel) const {
        const std::vector<Point> points = points_in(scene, panel);
        if (points.empty()) return "set multiplot next\n";
        // An error of 0 is not on a logarithmic axis: it is drawn on the lowest line.
        double least = 1.0;
        double greatest = 1e-4;
        double first = 1e30;
        double last = 0.0;
        for (const Point& point : points) {
            if (point.error > 0.0) least = std::min(least, point.error);
            greatest = std::max(greatest, point.error);
            first = std::min(first, point.ms);
            last = std::max(last, point.ms);
        }
        const double bottom = least / 1.6;
        const auto place = [&](const Point& point) {
            return fmt::format("{:.6g} {:.6g}", point.ms, std::max(point.error, bottom));
        };
        std::string lines;
        for (const Point& point : front_of(points))
            lines += fmt::format("{} {}\n", place(point), quoted(point.setting));
        std::string blocks = data_block("$front", lines);
        std::string plots = "plot $front using 1:2 with lines lw 5 lc \"#e0e0e0\" notitle";
        for (std::size_t s = 0; s < series_.size(); ++s) {
            lines.clear();
            for (const Point& point : points)
                if (point.series == series_[s].first + series_[s].second) lines += place(point) + "\n";
            if (lines.empty()) continue;
            blocks += data_block(fmt::format("$s{}", s), lines);
            const Style style = style_of(s);
            plots +=
                fmt::format(", $s{} using 1:2 with linespoints pt {} ps 1 lw 1.3 dt {} lc \"{}\" notitle", s,
                            style.point, style.dash, style.color);
        }
        plots +=
            ", $front using 1:2 with points pt 6 ps 2 lw 1.3 lc \"#000000\" notitle, $front using 1:2:3 with "
            "labels offset 0,-0.9 font \"sans,8\" notitle\n";
        std::string out = blocks;
        out += fmt::format("set title {} offset 0,-0.6\nset ylabel {} offset 1.5,0\n",
                           quoted(fmt::format("{}: {}", scene, panel.title)),
                           quoted(std::string(panel.light) == "hard" ? "pixels on the wrong side" : "RMSE"));
        out += axis_ranges(first / 1.4, last * 1.4, bottom, greatest * 1.3);
        return out + plots + "unset label\n";
    }

    /// The key of all panels, along the bottom.
    [[nodiscard]] std::string key(double top, int rows) const {
        std::string out =
            "set size 1,1\nset origin 0,0\nset lmargin at screen 0\nset rmargin at screen 1\n"
            "set bmargin at screen 0\nset tmargin at screen 0.01\n"
            "unset border\nunset tics\nunset xlabel\nunset ylabel\nunset title\nunset grid\nunset logscale\n"
            "set xrange [0:1]\nset yrange [0:1]\n";
        out += fmt::format(
            "set key at screen 0.97,{:.4f} right top horizontal Left reverse samplen 3 "
            "maxrows {} font \"sans,11\"\nplot ",
            top, rows);
        for (std::size_t s = 0; s < series_.size(); ++s) {
            const Style style = style_of(s);
            out += fmt::format("{}NaN with linespoints pt {} ps 1 lw 1.3 dt {} lc \"{}\" title {}",
                               s == 0 ? "" : ", ", style.point, style.dash, style.color,
                               quoted(fmt::format("{}: {}", series_[s].first, series_[s].second)));
        }
        return out + "\n";
    }

    std::vector<Point> points_;
    std::vector<std::string> scenes_;
    std::vector<std::pair<std::string, std::string>> series_;
    Machine machine_;
};

}  // namespace

std::string shadow_plot(const Table& table, const std::filesystem::path& picture) {
    return ShadowPlot(table).script(picture);
}

}  // namespace cairn::bench

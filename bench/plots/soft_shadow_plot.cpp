#include "bench/plots/soft_shadow_plot.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "bench/plots/panel.h"

namespace cairn::bench {
namespace {

struct Point {
    std::string occluder, study, format, window;
    double parameter = 0.0;
    std::int64_t size = 0;
    std::int64_t passes = 0;
    double error = 0.0;
    double ms = 0.0;
};

/// The style of a line. Black comes last.
const PlotStyle& line_style(std::size_t line) {
    return plot_styles[(line + 1) % plot_styles.size()];
}

// Height of a panel over that of its curves, for their names.
constexpr double headroom = 1.45;

struct Series {
    std::string title;
    std::function<bool(const Point&)> holds;
};

struct Panel {
    std::string title, x_label, axes;  ///< `axes`: commands for scales and ranges
    bool is_time = false;
    std::vector<Series> series;
    double power = 1.0;  ///< exponent of the parameter on the horizontal axis
};

class SoftShadowPlot {
public:
    explicit SoftShadowPlot(const Table& table) : machine_(machine_of(table)) {
        for (const Row& row : rows_of(table)) {
            points_.push_back({row.text("occluder"), row.text("study"), row.text("format"),
                               row.text("window"), row.number("parameter"), row.whole("occluder_size"),
                               row.whole("passes"), row.number("error"), row.number("ms")});
            add_once(occluders_, points_.back().occluder);
            if (points_.back().study == "light-size") add_once(light_sizes_, points_.back().size);
        }
        std::sort(light_sizes_.begin(), light_sizes_.end());
    }

    [[nodiscard]] std::string script(const std::filesystem::path& picture) const {
        const int rows = int(occluders_.size()) + 1;
        const PanelGrid grid{.rows = rows,
                             .columns = 4,
                             .width = 1800,
                             .height = 110 + 360 * rows,
                             .font = 11,
                             .left = 0.045,
                             .right = 0.985,
                             .head = 100,
                             .foot = 50,
                             .row_gap = 85,
                             .column_gap = 0.045};
        std::string out = open_picture(grid, picture) + open_panels(grid);
        out += label({1, "Soft shadow maps: mean error over shadow and penumbra (above), and time (below)",
                      15, grid.from_top(24)});
        out += label({2, machine_.words() + ". Atty et al. 2005, figures 17 to 20, and 21 to 23 and 14", 10,
                      grid.from_top(48)});
        out +=
            "set grid lc \"#e4e4e4\" lt 1\nset border lc \"#888888\"\nset tics nomirror\n"
            "set key top left Left reverse samplen 1.5 font \"sans,9\"\n";
        for (const std::string& occluder : occluders_)
            for (const Panel& panel : error_panels(occluder))
                out += draw(panel);
        for (const Panel& panel : time_panels())
            out += draw(panel);
        return out + "unset multiplot\n";
    }

private:
    /// A series of one study with fitted windows in FP32.
    static Series passes_of(const std::string& occluder, const char* study, std::int64_t passes,
                            std::int64_t size = 0) {
        return {passes == 1 ? "one pass" : "two passes", [=](const Point& p) {
                    return p.occluder == occluder && p.study == study && p.passes == passes &&
                           p.window == "fitted" && (size == 0 || p.size == size);
                }};
    }

    [[nodiscard]] std::int64_t base_size() const {
        return light_sizes_.empty() ? 0 : light_sizes_[light_sizes_.size() / 2];
    }

    [[nodiscard]] std::vector<Panel> error_panels(const std::string& occluder) const {
        const std::array<std::array<const char*, 4>, 4> kinds = {
            {{"resolution", "size of the occluder map", "texels per side", "set logscale x 2\n"},
             {"light-size", "width of the light", "occluder = 1", ""},
             {"lateral", "lateral position", "from the light's axis, occluder = 1", ""},
             {"vertical", "vertical position", "0 on the floor, 1 at the light", ""}}};
        std::vector<Panel> panels;
        for (const auto& [study, title, x_label, axes] : kinds) {
            const std::string name = study;
            const bool over_lights = name == "light-size";
            const std::int64_t base = over_lights ? base_size() : 0;
            Panel panel{occluder + ": " + title,
                        x_label,
                        axes,
                        false,
                        {passes_of(occluder, study, 1, base),
                         {"one pass, one window for both maps",
                          [=](const Point& p) {
                              return p.occluder == occluder && p.study == name && p.window == "shared";
                          }},
                         passes_of(occluder, study, 2, base)}};
            for (const std::int64_t size : light_sizes_) {
                if (!over_lights || size == base) continue;
                panel.series.push_back(passes_of(occluder, study, 2, size));
                panel.series.back().title = fmt::format("two passes, {}²", size);
            }
            panels.push_back(std::move(panel));
        }
        return panels;
    }

    [[nodiscard]] std::vector<Panel> time_panels() const {
        Panel polygons{"time over triangles", "triangles", "set format x \"%.0s%c\"\n", true, {}};
        Panel texels{"time over the occluder map", "texels", "set format x \"%.0s%c\"\n", true, {}, 2.0};
        Panel lights{occluders_.back() + ": time over the light", "width, occluder = 1", "", true, {}};
        Panel formats{occluders_.front() + ": what sums are kept in (one pass)",
                      "texels per side",
                      "set logscale x 2\n",
                      false,
                      {}};
        for (const std::string& occluder : occluders_) {
            polygons.series.push_back(passes_of(occluder, "polygons", 2));
            polygons.series.back().title = occluder;
            for (const std::int64_t passes : {1, 2}) {
                texels.series.push_back(passes_of(occluder, "resolution", passes));
                texels.series.back().title =
                    fmt::format("{}, {}", occluder, passes == 1 ? "one pass" : "two passes");
            }
        }
        for (const std::int64_t size : light_sizes_) {
            lights.series.push_back(passes_of(occluders_.back(), "light-size", 2, size));
            lights.series.back().title = fmt::format("{}²", size);
        }
        for (const char* format : {"fp16", "fp16-batches", "fp32"})
            formats.series.push_back({format, [=, this](const Point& p) {
                                          return p.occluder == occluders_.front() && p.study == "format" &&
                                                 p.format == format;
                                      }});
        return {polygons, texels, lights, formats};
    }

    [[nodiscard]] std::string draw(const Panel& panel) const {
        std::string out;
        std::string plots;
        double greatest = 0.0;
        for (std::size_t s = 0; s < panel.series.size(); ++s) {
            std::string lines;
            for (const Point& point : points_) {
                if (!panel.series[s].holds(point)) continue;
                const double x = panel.power == 2.0 ? point.parameter * point.parameter : point.parameter;
                const double y = panel.is_time ? point.ms : point.error;
                greatest = std::max(greatest, y);
                lines += fmt::format("{:.6g} {:.6g}\n", x, y);
            }
            if (lines.empty()) continue;
            out += data_block(fmt::format("$s{}", s), lines);
            const PlotStyle& style = line_style(s);
            plots += fmt::format("{} $s{} using 1:2 with linespoints pt {} ps 0.9 lw 1.4 lc \"{}\" title {}",
                                 plots.empty() ? "plot" : ",", s, style.point, style.color,
                                 quoted(panel.series[s].title));
        }
        if (plots.empty()) return "set multiplot next\n";
        out += fmt::format(
            "unset logscale\nset format \"%g\"\nset autoscale x\nset yrange [0:{:.6g}]\n{}"
            "set title {} offset 0,-0.7\nset xlabel {} offset 0,0.5\nset ylabel {} offset 0.5,0\n",
            greatest > 0.0 ? headroom * greatest : 1.0, panel.axes, quoted(panel.title),
            quoted(panel.x_label), quoted(panel.is_time ? "milliseconds" : "error"));
        return out + plots + "\nunset label\n";
    }

    std::vector<Point> points_;
    std::vector<std::string> occluders_;
    std::vector<std::int64_t> light_sizes_;
    Machine machine_;
};

}  // namespace

std::string soft_shadow_plot(const Table& table, const std::filesystem::path& picture) {
    return SoftShadowPlot(table).script(picture);
}

}  // namespace cairn::bench

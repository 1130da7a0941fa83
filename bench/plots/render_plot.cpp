#include "bench/plots/render_plot.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "bench/plots/plot_style.h"

namespace cairn::bench {
namespace {

struct Point {
    std::string scene, varied, series;
    double pixel_error = 1.0;
    double ms = 0.0;
    std::array<double, 2> errors{};  ///< of colours, of the silhouette
};

class Plot {
public:
    explicit Plot(const Table& table) {
        const auto column = [&](const char* name) {
            return std::size_t(std::find(table.columns.begin(), table.columns.end(), name) -
                               table.columns.begin());
        };
        for (const std::vector<Cell>& row : table.rows) {
            const auto text = [&](const char* name) { return std::get<std::string>(row[column(name)]); };
            const auto whole = [&](const char* name) { return std::get<std::int64_t>(row[column(name)]); };
            const auto number = [&](const char* name) { return std::get<double>(row[column(name)]); };
            Point point{text("scene"),         text("varied"), {},
                        number("pixel_error"), number("ms"),   {number("rmse"), number("silhouette")}};
            point.series = point.varied == "shape" ? fmt::format("N {}, M {}", whole("n"), whole("m"))
                           : point.varied == "traversal"
                               ? text("traversal")
                               : fmt::format("pool of {:g} MiB", number("pool_mib"));
            add_once(scenes_, point.scene);
            add_once(series_, point.series);
            points_.push_back(point);
            driver_ = text("driver");
            threads_ = whole("threads");
        }
    }

    [[nodiscard]] std::string script(const std::filesystem::path& picture) const {
        const int height = 130 + 480 * int(scenes_.size());
        std::string out = fmt::format(
            "set terminal pngcairo noenhanced size 1400,{} font \"sans,12\" background \"#ffffff\"\n"
            "set output {}\n",
            height, quoted(picture.string()));
        out += fmt::format("set multiplot layout {},2 margins 0.07,0.82,{:.4f},{:.4f} spacing 0.07,{:.4f}\n",
                           scenes_.size(), 70.0 / height, 1.0 - 90.0 / height, 90.0 / height);
        out += label(1, "Converged frames: time against error; down and to the left is better", 15,
                     1.0 - 24.0 / height);
        out += label(2,
                     fmt::format("{}, {} threads. Labels: pixel error. Ring: no other is faster and nearer "
                                 "to the picture with 64 samples a pixel",
                                 driver_, threads_),
                     10, 1.0 - 48.0 / height);
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
    static std::string label(int number, const std::string& text, int size, double height) {
        return fmt::format("set label {} {} at screen 0.45,{:.4f} center font \"sans,{}\"\n", number,
                           quoted(text), height, size);
    }

    [[nodiscard]] bool on_front(const Point& point, std::size_t error) const {
        return std::none_of(points_.begin(), points_.end(), [&](const Point& other) {
            return other.scene == point.scene && other.ms <= point.ms &&
                   other.errors[error] <= point.errors[error] &&
                   (other.ms < point.ms || other.errors[error] < point.errors[error]);
        });
    }

    [[nodiscard]] std::string panel(const std::string& scene, std::size_t error) const {
        std::string blocks = "$front << EOD\n";
        std::vector<Point> front;
        for (const Point& point : points_)
            if (point.scene == scene && on_front(point, error)) front.push_back(point);
        std::sort(front.begin(), front.end(), [](const Point& a, const Point& b) { return a.ms < b.ms; });
        for (const Point& point : front)
            blocks += fmt::format("{:.6g} {:.6g}\n", point.ms, point.errors[error]);
        blocks += "EOD\n$labels << EOD\n";
        // Where several pixel errors take the same levels, the first has the label.
        double labelled = -1.0;
        for (const Point& point : points_) {
            if (point.scene != scene || point.series != series_.front() || point.errors[error] == labelled)
                continue;
            labelled = point.errors[error];
            blocks += fmt::format("{:.6g} {:.6g} {:.3g}\n", point.ms, labelled, point.pixel_error);
        }
        blocks += "EOD\n";
        std::string plots = "plot $front using 1:2 with lines lw 4 lc \"#dddddd\" title \"front\"";
        for (std::size_t s = 0; s < series_.size(); ++s) {
            blocks += fmt::format("$s{} << EOD\n", s);
            bool is_line = false;
            for (const Point& point : points_) {
                if (point.scene != scene || point.series != series_[s]) continue;
                blocks += fmt::format("{:.6g} {:.6g}\n", point.ms, point.errors[error]);
                is_line = point.varied == "shape";
            }
            blocks += "EOD\n";
            const PlotStyle& style = plot_styles[s % plot_styles.size()];
            plots += fmt::format(", $s{} using 1:2 with {} pt {} ps {} lw 1.4 lc \"{}\" title {}", s,
                                 is_line ? "linespoints" : "points", is_line ? style.point : 2,
                                 is_line ? 1.1 : 1.8, style.color, quoted(series_[s]));
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
        out += ranges(scene, error);
        return out + plots + "unset label\n";
    }

    [[nodiscard]] std::string ranges(const std::string& scene, std::size_t error) const {
        constexpr double margin = 1.4;
        std::array<double, 4> ends = {1e30, 0.0, 1e30, 0.0};
        for (const Point& point : points_) {
            if (point.scene != scene) continue;
            ends = {std::min(ends[0], point.ms), std::max(ends[1], point.ms),
                    std::min(ends[2], point.errors[error]), std::max(ends[3], point.errors[error])};
        }
        return fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n", ends[0] / margin,
                           ends[1] * margin, std::max(ends[2], 1e-6) / margin,
                           std::max(ends[3], 1e-6) * margin);
    }

    std::vector<Point> points_;
    std::vector<std::string> scenes_, series_;
    std::string driver_;
    std::int64_t threads_ = 0;
};

}  // namespace

std::string render_plot(const Table& table, const std::filesystem::path& picture) {
    return Plot(table).script(picture);
}

}  // namespace cairn::bench

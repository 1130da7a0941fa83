#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/plots/table.h"

/// What the charts' pictures have in common: panels side by side under a title, in gnuplot's language.
namespace cairn::bench {

struct PlotStyle {
    const char* color;
    int point;  ///< gnuplot's number of the point type
};

/// Black, then Okabe and Ito's colours, which the colour-blind can distinguish, and two more.
constexpr std::array<PlotStyle, 9> plot_styles = {{{"#000000", 7},
                                                   {"#0072b2", 7},
                                                   {"#d55e00", 5},
                                                   {"#009e73", 9},
                                                   {"#cc79a7", 13},
                                                   {"#e69f00", 11},
                                                   {"#56b4e9", 15},
                                                   {"#777777", 7},
                                                   {"#a0522d", 5}}};

/// Text between double quotes, without characters that gnuplot would read as a format or a command.
[[nodiscard]] std::string quoted(const std::string& text);

/// A picture of panels in rows and columns.
struct PanelGrid {
    int rows = 1;
    int columns = 1;
    int width = 1200;  ///< pixels of the picture
    int height = 600;  ///< pixels of the picture
    int font = 12;
    /// Left and right ends of the panels, as shares of the picture's width.
    double left = 0.0;
    double right = 1.0;
    /// Pixels above and below the panels, and between their rows.
    int head = 90;
    int foot = 70;
    int row_gap = 90;
    /// Gap between columns, as a share of the picture's width.
    double column_gap = 0.05;

    /// A height above the picture's bottom, as a share of the picture's height, from pixels below its top or
    /// above its bottom.
    [[nodiscard]] double from_top(int pixels) const { return 1.0 - double(pixels) / height; }
    [[nodiscard]] double from_bottom(int pixels) const { return double(pixels) / height; }
};

/// The commands that begin a picture.
[[nodiscard]] std::string open_picture(const PanelGrid& grid, const std::filesystem::path& picture);
/// The commands that begin the panels. "unset multiplot" ends them.
[[nodiscard]] std::string open_panels(const PanelGrid& grid);

/// A line of text in the picture, centred.
struct Label {
    int number = 1;  ///< gnuplot's number of the label
    std::string text;
    int size = 15;        ///< size of the font
    double height = 1.0;  ///< height, as a share of the picture's height
    double middle = 0.5;  ///< middle, as a share of the picture's width
    std::string color = {};
};
[[nodiscard]] std::string label(const Label& label);

/// A gnuplot data block: lines of figures under a name for "plot", "$front" for instance.
[[nodiscard]] std::string data_block(const std::string& name, const std::string& lines);

/// The commands that set the ranges of both axes.
[[nodiscard]] std::string axis_ranges(double left, double right, double bottom, double top);

/// The machine on which a table was measured, by its last row.
struct Machine {
    std::string driver;
    std::int64_t threads = 0;

    [[nodiscard]] std::string words() const;  ///< "llvmpipe, 2 threads"
};
[[nodiscard]] Machine machine_of(const Table& table);

/// Time and error of a point, the less of each the better. Points that no other beats are ringed.
struct TimeAndError {
    double ms = 0.0;
    double error = 0.0;
};
/// True if `other` is better in neither, and worse in at least one.
[[nodiscard]] bool beats(const TimeAndError& one, const TimeAndError& other);

/// Appends the value if the list does not hold it yet.
template <typename T>
void add_once(std::vector<T>& list, const T& value) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

}  // namespace cairn::bench

#include "bench/plots/panel.h"

#include <fmt/format.h>

namespace cairn::bench {

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out + '"';
}

std::string open_picture(const PanelGrid& grid, const std::filesystem::path& picture) {
    return fmt::format(
        "set terminal pngcairo noenhanced size {},{} font \"sans,{}\" background \"#ffffff\"\n"
        "set output {}\n",
        grid.width, grid.height, grid.font, quoted(picture.string()));
}

std::string open_panels(const PanelGrid& grid) {
    return fmt::format("set multiplot layout {},{} margins {},{},{:.4f},{:.4f} spacing {},{:.4f}\n",
                       grid.rows, grid.columns, grid.left, grid.right, grid.from_bottom(grid.foot),
                       grid.from_top(grid.head), grid.column_gap, grid.from_bottom(grid.row_gap));
}

std::string label(const Label& label) {
    const std::string color = label.color.empty() ? "" : fmt::format(" tc {}", quoted(label.color));
    return fmt::format("set label {} {} at screen {},{:.4f} center font \"sans,{}\"{}\n", label.number,
                       quoted(label.text), label.middle, label.height, label.size, color);
}

std::string data_block(const std::string& name, const std::string& lines) {
    return fmt::format("{} << EOD\n{}EOD\n", name, lines);
}

std::string axis_ranges(double left, double right, double bottom, double top) {
    return fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n", left, right, bottom, top);
}

std::string Machine::words() const {
    return fmt::format("{}, {} threads", driver, threads);
}

Machine machine_of(const Table& table) {
    if (table.rows.empty()) return {};
    const Row last(table, table.rows.size() - 1);
    return {last.text("driver"), last.whole("threads")};
}

bool beats(const TimeAndError& one, const TimeAndError& other) {
    return one.ms <= other.ms && one.error <= other.error && (one.ms < other.ms || one.error < other.error);
}

}  // namespace cairn::bench

#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

/// What the charts' pictures have in common.
namespace cairn::bench {

struct PlotStyle {
    const char* color;
    int point;  ///< gnuplot's number
};

/// Black, then Okabe and Ito's colours and two more, told apart by all.
constexpr std::array<PlotStyle, 9> plot_styles = {{{"#000000", 7},
                                                   {"#0072b2", 7},
                                                   {"#d55e00", 5},
                                                   {"#009e73", 9},
                                                   {"#cc79a7", 13},
                                                   {"#e69f00", 11},
                                                   {"#56b4e9", 15},
                                                   {"#777777", 7},
                                                   {"#a0522d", 5}}};

/// Text between double quotes, with nothing that gnuplot would read as a format or a command.
[[nodiscard]] std::string quoted(const std::string& text);

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

}  // namespace cairn::bench

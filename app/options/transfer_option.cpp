#include "app/options/transfer_option.h"

#include <string_view>

#include <fmt/format.h>

#include "app/options/names.h"
#include "app/options/parse.h"
#include "base/error.h"

namespace cairn::app {
namespace {

constexpr const char* option = "--transfer";

// Colours are linear.
Names<std::string_view> named_points() {
    return {
        // For any volume: densities above a tenth of the range show, the denser the more opaque.
        {"solid", "0.1:0.75,0.7,0.62:0;0.3:0.75,0.7,0.62:0.5;1:0.95,0.92,0.85:2"},
        // For scans with contrast for bones: soft parts are a haze.
        {"bone", "0.08:0.5,0.08,0.04:0;0.25:0.6,0.15,0.08:0.015;0.4:0.85,0.7,0.5:0.4;1:1,0.97,0.9:3"},
        // All densities are thin, and brighter the denser they are.
        {"haze", "0.02:0.1,0.25,0.6:0;0.5:0.5,0.6,0.8:0.01;1:1,0.95,0.85:0.06"},
        // Extinction is proportional to density.
        {"opaque", "0:0.8,0.75,0.7:0;1:0.8,0.75,0.7:4"},
    };
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

}  // namespace

std::string transfer_names() {
    return joined(named_points(), ", ", ", ");
}

renderer::TransferFunction TransferChoice::for_voxels(double voxel_size) const {
    std::vector<renderer::ControlPoint> in_world = points;
    for (renderer::ControlPoint& point : in_world)
        point.extinction /= voxel_size;
    return renderer::TransferFunction(in_world);
}

TransferChoice parse_transfer(const std::string& text) {
    const std::string_view points = find_named(text, named_points()).value_or(text);
    if (points.find(':') == std::string_view::npos) {
        throw Error(
            Fault::usage, option, fmt::format("there is no \"{}\"", text),
            fmt::format("choose {}, or give points such as \"0.2:1,1,1:0;1:1,1,1:0.5\"", transfer_names()));
    }
    TransferChoice choice{text, {}};
    for (const std::string_view point : split(points, ';')) {
        const std::vector<std::string_view> parts = split(point, ':');
        if (parts.size() != 3) {
            throw Error(Fault::usage, option, fmt::format("\"{}\" is not DENSITY:R,G,B:EXTINCTION", point),
                        "for instance 0.5:1,0.9,0.8:0.2");
        }
        const std::vector<double> color = parse_numbers(option, parts[1], 3, 3);
        choice.points.push_back(
            {parse_number(option, parts[0]), {color[0], color[1], color[2]}, parse_number(option, parts[2])});
    }
    (void)choice.for_voxels(1.0);  // throws if a point is out of range
    return choice;
}

}  // namespace cairn::app

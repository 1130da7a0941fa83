#include "app/options/parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "base/error.h"
#include "renderer/view/view.h"

namespace cairn::app {
namespace {

template <typename Number>
std::optional<Number> read_whole(std::string_view text) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [stop, failed] = std::from_chars(text.data(), end, value);
    if (failed != std::errc() || stop != end || text.empty()) return std::nullopt;
    return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        parts.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

}  // namespace

int parse_int(std::string_view option, std::string_view text, int low, int high) {
    const std::optional<long long> value = read_whole<long long>(text);
    if (!value || *value < low || *value > high) {
        throw Error(Fault::usage, std::string(option),
                    fmt::format("\"{}\" is not a whole number from {} to {}", text, low, high));
    }
    return int(*value);
}

std::uint64_t parse_count(std::string_view option, std::string_view text) {
    constexpr std::uint64_t most = std::uint64_t(1) << 53U;
    const std::optional<std::uint64_t> value = read_whole<std::uint64_t>(text);
    if (!value || *value > most) {
        throw Error(Fault::usage, std::string(option),
                    fmt::format("\"{}\" is not a whole number from 0 to 2^53", text));
    }
    return *value;
}

double parse_number(std::string_view option, std::string_view text) {
    const std::optional<double> value = read_whole<double>(text);
    if (!value) throw Error(Fault::usage, std::string(option), fmt::format("\"{}\" is not a number", text));
    if (!std::isfinite(*value)) {
        throw Error(Fault::usage, std::string(option), fmt::format("\"{}\" is not finite", text));
    }
    return *value;
}

std::vector<double> parse_numbers(std::string_view option, std::string_view text, std::size_t least,
                                  std::size_t most) {
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() < least || parts.size() > most) {
        const std::string wanted =
            least == most ? std::to_string(least) : fmt::format("{} or {}", least, most);
        throw Error(Fault::usage, std::string(option),
                    fmt::format("\"{}\" has {} of the {} numbers it needs", text, parts.size(), wanted),
                    "write them with commas and no spaces: 1,2.5,-3");
    }
    std::vector<double> numbers(parts.size());
    std::ranges::transform(parts, numbers.begin(),
                           [&](std::string_view part) { return parse_number(option, part); });
    return numbers;
}

glm::ivec3 parse_axes(std::string_view option, std::string_view text, int low, int high) {
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() != 1 && parts.size() != 3) {
        throw Error(Fault::usage, std::string(option),
                    fmt::format("\"{}\" has {} numbers, not 1 or 3", text, parts.size()),
                    "write one for a cube, or three with commas and no spaces: 640,480,512");
    }
    glm::ivec3 axes(parse_int(option, parts[0], low, high));
    for (int axis = 1; parts.size() == 3 && axis < 3; ++axis)
        axes[axis] = parse_int(option, parts[std::size_t(axis)], low, high);
    return axes;
}

double degrees_of(double radians) {
    constexpr double steps_per_degree = 1e9;
    return std::round(glm::degrees(radians) * steps_per_degree) / steps_per_degree;
}

std::pair<int, int> parse_size(std::string_view option, std::string_view text) {
    const std::vector<std::string_view> parts = split(text, 'x');
    if (parts.size() != 2) {
        throw Error(Fault::usage, std::string(option), fmt::format("\"{}\" is not WIDTHxHEIGHT", text),
                    "for example 1024x768");
    }
    return {parse_int(option, parts[0], 1, renderer::MAX_PICTURE_SIDE),
            parse_int(option, parts[1], 1, renderer::MAX_PICTURE_SIDE)};
}

}  // namespace cairn::app

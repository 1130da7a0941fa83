#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

/// Numbers on the command line: the whole text is read ("12abc" is not a number), and the number must be
/// finite and within its range.
///
/// Every function throws Error (Fault::usage) that names the option and repeats what was given.
namespace cairn::app {

/// @param low, high  the range, both ends included.
[[nodiscard]] int parse_int(std::string_view option, std::string_view text, int low, int high);
/// A whole number up to 2^53.
[[nodiscard]] std::uint64_t parse_count(std::string_view option, std::string_view text);
[[nodiscard]] double parse_number(std::string_view option, std::string_view text);

/// Numbers separated by commas, "1,2.5,-3": at least `least` and at most `most` of them.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view option, std::string_view text,
                                                std::size_t least, std::size_t most);

/// "512" or "640,480,512": one number for all three axes, or one per axis; each within [low, high].
[[nodiscard]] glm::ivec3 parse_axes(std::string_view option, std::string_view text, int low, int high);

/// An angle in degrees, rounded to 1e-9, so that degrees survive the way to radians and back.
[[nodiscard]] double degrees_of(double radians);

/// Width and height, "640x480", each within [1, renderer::MAX_PICTURE_SIDE].
[[nodiscard]] std::pair<int, int> parse_size(std::string_view option, std::string_view text);

}  // namespace cairn::app

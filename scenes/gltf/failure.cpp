#include "scenes/gltf/failure.h"

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::scenes::gltf {

void fail(const std::string& where, const std::string& what, const std::string& way_out) {
    throw Error(Fault::input, where, what, way_out);
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 80;
    const bool cut = text.size() > longest;
    std::string result = "\"";
    for (const char letter : text.substr(0, longest)) {
        const auto code = static_cast<unsigned char>(letter);
        result += code < 0x20 || code == 0x7F ? '?' : letter;
    }
    // Never end inside a UTF-8 sequence.
    while (cut && !result.empty() && (static_cast<unsigned char>(result.back()) & 0x80U) != 0)
        result.pop_back();
    result += cut ? "...\"" : "\"";
    return result;
}

std::string element(std::string_view kind, std::size_t index, std::string_view name) {
    if (name.empty()) return fmt::format("{} {}", kind, index);
    return fmt::format("{} {} {}", kind, index, in_quotes(name));
}

}  // namespace cairn::scenes::gltf

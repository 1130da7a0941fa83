#include "scenes/gltf/uri.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "base/input_file.h"
#include "scenes/gltf/failure.h"
#include "scenes/gltf/limits.h"

namespace cairn::scenes::gltf {
namespace {

int hex_digit(char letter) {
    if (letter >= '0' && letter <= '9') return letter - '0';
    if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
    if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
    return -1;
}

/// A % that no two hexadecimal digits follow stands for itself: many exporters forget to encode.
std::string percent_decoded(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool encoded = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
                             hex_digit(text[i + 2]) >= 0;
        result += encoded ? static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
        if (encoded) i += 2;
    }
    return result;
}

constexpr std::uint8_t no_digit = 0xFF;

/// The value of each base64 digit, by its character.
constexpr std::array<std::uint8_t, 256> base64_values() {
    std::array<std::uint8_t, 256> values{};
    for (auto& value : values)
        value = no_digit;
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<unsigned char>(digits[i])] = static_cast<std::uint8_t>(i);
    return values;
}

std::vector<std::uint8_t> base64_decoded(const std::string& where, std::string_view text) {
    static constexpr auto values = base64_values();
    while (!text.empty() && text.back() == '=')
        text.remove_suffix(1);
    std::vector<std::uint8_t> result;
    result.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char letter : text) {
        const std::uint8_t value = values[static_cast<unsigned char>(letter)];
        if (value == no_digit) fail(where, "its data: URI holds a character that is not base64");
        bits = (bits << 6U) | value;
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        result.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(bit_count)));
    }
    return result;
}

/// RFC 3986, 3.1. One letter is a drive of Windows, and just as unwelcome.
bool has_scheme(std::string_view uri) {
    std::size_t i = 0;
    while (i < uri.size() && (std::isalnum(static_cast<unsigned char>(uri[i])) != 0 || uri[i] == '+' ||
                              uri[i] == '-' || uri[i] == '.'))
        ++i;
    return i > 0 && i < uri.size() && uri[i] == ':' && std::isalpha(static_cast<unsigned char>(uri[0])) != 0;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    constexpr std::string_view scheme = "data:";
    if (uri.size() < scheme.size()) return false;
    for (std::size_t i = 0; i < scheme.size(); ++i)
        if (std::tolower(static_cast<unsigned char>(uri[i])) != scheme[i]) return false;
    return true;
}

std::vector<std::uint8_t> decode_data_uri(const std::string& where, std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) fail(where, "its data: URI has no comma, hence no data");
    const std::string_view head = uri.substr(0, comma);
    const std::string_view body = uri.substr(comma + 1);
    if (head.ends_with(";base64")) {
        if (body.find('%') == std::string_view::npos) return base64_decoded(where, body);
        return base64_decoded(where, percent_decoded(body));
    }
    const std::string bytes = percent_decoded(body);
    return {bytes.begin(), bytes.end()};
}

std::filesystem::path resolve_uri(const std::string& where, std::string_view uri,
                                  const std::filesystem::path& folder, bool trust_paths) {
    if (uri.empty()) fail(where, "its URI is empty");
    if (has_scheme(uri))
        fail(where,
             fmt::format("its URI {} has a scheme; only data: and file names are read", in_quotes(uri)),
             "save what it points to beside the file and name it there");
    // Before decoding: an encoded backslash is part of a name.
    std::string slashed(uri);
    std::ranges::replace(slashed, '\\', '/');
    const std::string decoded = percent_decoded(slashed);
    if (decoded.find('\0') != std::string::npos) fail(where, "its URI holds a zero byte");
    const auto path = std::filesystem::path(decoded).lexically_normal();
    if (!trust_paths) {
        constexpr const char* way_out = "if you trust the file, allow it with LoadOptions::trust_paths";
        if (path.is_absolute())
            fail(where, fmt::format("its URI {} is an absolute path", in_quotes(uri)), way_out);
        if (!path.empty() && *path.begin() == "..")
            fail(where, fmt::format("its URI {} leaves the folder of the file", in_quotes(uri)), way_out);
    }
    return folder / path;
}

std::vector<std::uint8_t> read_file(const std::string& where, const std::filesystem::path& path,
                                    const Limits& limits, const std::filesystem::path& folder) {
    InputFile file(where, path, folder);
    if (file.size_bytes() > limits.file_bytes)
        fail_limit(where,
                   fmt::format("{} holds {} bytes", in_quotes(path.filename().string()), file.size_bytes()),
                   &Limits::file_bytes, file.size_bytes());
    std::vector<std::uint8_t> bytes(file.size_bytes());
    file.read(bytes.data(), bytes.size());
    return bytes;
}

std::vector<std::uint8_t> read_uri(const std::string& where, std::string_view uri,
                                   const std::filesystem::path& folder, const LoadOptions& options) {
    if (is_data_uri(uri)) return decode_data_uri(where, uri);
    const std::filesystem::path path = resolve_uri(where, uri, folder, options.trust_paths);
    const std::filesystem::path inside = folder.empty() ? std::filesystem::path(".") : folder;
    return read_file(where, path, options.limits, options.trust_paths ? std::filesystem::path() : inside);
}

}  // namespace cairn::scenes::gltf

#include "scenes/gltf/container.h"

#include <cstring>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/limits.h"

namespace cairn::scenes::gltf {
namespace {

constexpr std::uint32_t magic_glb = 0x46546C67;     // "glTF"
constexpr std::uint32_t chunk_json = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t chunk_binary = 0x004E4942;  // "BIN"
constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;

std::uint32_t little_endian(std::span<const std::uint8_t> file, std::size_t at) {
    return static_cast<std::uint32_t>(file[at]) | static_cast<std::uint32_t>(file[at + 1]) << 8U |
           static_cast<std::uint32_t>(file[at + 2]) << 16U | static_cast<std::uint32_t>(file[at + 3]) << 24U;
}

struct Chunk {
    std::uint32_t type = 0;
    std::span<const std::uint8_t> bytes;
};

/// Reads the chunk at `at` and moves behind it.
Chunk next_chunk(const std::string& name, std::span<const std::uint8_t> file, std::size_t& at) {
    if (file.size() - at < chunk_header_bytes)
        fail(name, fmt::format("it ends at byte {}, inside a chunk's header", file.size()));
    const std::size_t length = little_endian(file, at);
    const std::uint32_t type = little_endian(file, at + 4);
    at += chunk_header_bytes;
    if (length > file.size() - at)
        fail(name, fmt::format("a chunk ends at byte {}, the file at {}", at + length, file.size()),
             "the file is cut short; copy it again");
    const Chunk chunk{type, file.subspan(at, length)};
    at += length;
    return chunk;
}

Container split_glb(const std::string& name, std::span<const std::uint8_t> file) {
    if (file.size() < header_bytes)
        fail(name, "it ends inside the .glb header", "the file is cut short; copy it again");
    const std::uint32_t version = little_endian(file, 4);
    if (version != 2)
        fail(name, fmt::format("it is a .glb of version {}; only 2 is read", version),
             "convert it to glTF 2.0");
    const std::size_t length = little_endian(file, 8);
    if (length > file.size())
        fail(name, fmt::format("its header says {} bytes, the file has {}", length, file.size()),
             "the file is cut short; copy it again");
    if (length < header_bytes) fail(name, fmt::format("its header says {} bytes", length));
    const auto body = file.first(length);
    std::size_t at = header_bytes;
    const Chunk json = next_chunk(name, body, at);
    if (json.type != chunk_json) fail(name, "its first chunk is not JSON");
    Container result{{reinterpret_cast<const char*>(json.bytes.data()), json.bytes.size()}, {}, true};
    // Up to three bytes of padding may remain; chunks of other types may follow and are none of our business.
    if (body.size() - at >= chunk_header_bytes) {
        const Chunk second = next_chunk(name, body, at);
        if (second.type == chunk_binary) result.binary = second.bytes;
    }
    return result;
}

}  // namespace

Container split_container(const std::string& name, std::span<const std::uint8_t> file, const Limits& limits) {
    if (file.size() >= 4 && little_endian(file, 0) == magic_glb) return split_glb(name, file);
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const std::size_t start = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    const std::size_t first = text.find_first_not_of(" \t\r\n", start);
    if (first == std::string_view::npos) fail(name, "the file is empty", "copy or export it again");
    if (text[first] != '{')
        fail(name, "it is neither a .glb nor JSON", "name a .gltf or .glb file, or builtin:NAME");
    if (text.size() > limits.json_bytes)
        fail_limit(name, fmt::format("it holds {} bytes of JSON", text.size()), &Limits::json_bytes,
                   text.size());
    return {text.substr(start), {}, false};
}

void check_json_size(const std::string& name, std::string_view json, const Limits& limits) {
    int depth = 0;
    std::uint64_t value_count = 1;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char letter = json[i];
        if (in_string) {
            if (letter == '\\') ++i;
            if (letter == '"') in_string = false;
            continue;
        }
        if (letter == '"') in_string = true;
        if (letter == '[' || letter == '{') {
            if (++depth > deepest_json)
                fail(name, fmt::format("its JSON nests deeper than {} levels, at byte {}", deepest_json, i));
            ++value_count;
        }
        if (letter == ']' || letter == '}') --depth;
        if (letter == ',') ++value_count;
    }
    if (value_count > limits.json_values)
        fail_limit(name, fmt::format("its JSON holds {} values", value_count), &Limits::json_values,
                   value_count);
}

}  // namespace cairn::scenes::gltf

#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cairn::test {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

template <typename Number>
Bytes bytes_of(const std::vector<Number>& numbers) {
    Bytes bytes(numbers.size() * sizeof(Number));
    if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

template <typename Number>
constexpr int component_type() {
    if constexpr (std::is_same_v<Number, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<Number, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<Number, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<Number, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<Number, std::uint32_t>) return 5125;
    if constexpr (std::is_same_v<Number, float>) return 5126;
}

inline std::size_t width_of(const std::string& type) {
    if (type == "MAT4") return 16;
    return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

inline void write_bytes(const std::filesystem::path& path, const void* data, std::size_t size) {
    std::ofstream(path, std::ios::binary)
        .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

/// A glTF file under construction. Tests may change `json` as they like, to valid or invalid JSON.
struct GltfFile {
    Json json = {{"asset", {{"version", "2.0"}}}};
    Bytes binary;

    /// Appends one element to a top-level array; returns its index.
    int add(const char* array, Json element) {
        json[array].push_back(std::move(element));
        return static_cast<int>(json[array].size()) - 1;
    }

    int add_view(const Bytes& bytes, int stride = 0) {
        while (binary.size() % 4 != 0)
            binary.push_back(0);
        Json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
        if (stride != 0) view["byteStride"] = stride;
        binary.insert(binary.end(), bytes.begin(), bytes.end());
        return add("bufferViews", view);
    }

    template <typename Number>
    int add_accessor(const std::vector<Number>& numbers, const std::string& type, bool normalized = false) {
        Json accessor = {{"bufferView", add_view(bytes_of(numbers))},
                         {"componentType", component_type<Number>()},
                         {"count", numbers.size() / width_of(type)},
                         {"type", type}};
        if (normalized) accessor["normalized"] = true;
        return add("accessors", accessor);
    }

    /// Adds a mesh of one primitive and a node of the only scene that shows it. Returns the node's index.
    int add_mesh(const Json& primitive) {
        const int mesh = add("meshes", {{"primitives", Json::array({primitive})}});
        return add_root({{"mesh", mesh}});
    }

    int add_root(const Json& node) {
        const int index = add("nodes", node);
        if (!json.contains("scenes")) json["scenes"] = Json::array({{{"nodes", Json::array()}}});
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    [[nodiscard]] Json with_buffer(const std::string& uri) const {
        Json result = json;
        if (binary.empty() || !json.is_object() || json.contains("buffers")) return result;
        Json buffer = {{"byteLength", binary.size()}};
        if (!uri.empty()) buffer["uri"] = uri;
        result["buffers"] = Json::array({buffer});
        return result;
    }

    /// Writes a .gltf file, with its bytes in a .bin file beside it.
    void write_gltf(const std::filesystem::path& path) const {
        const std::string text = with_buffer(path.stem().string() + ".bin").dump();
        write_bytes(path, text.data(), text.size());
        auto beside = path;
        write_bytes(beside.replace_extension(".bin"), binary.data(), binary.size());
    }

    [[nodiscard]] Bytes glb() const {
        std::string text = with_buffer("").dump();
        while (text.size() % 4 != 0)
            text += ' ';
        Bytes padded = binary;
        while (padded.size() % 4 != 0)
            padded.push_back(0);
        Bytes file;
        const auto put = [&](std::size_t number) {
            for (unsigned shift = 0; shift < 32; shift += 8)
                file.push_back(static_cast<std::uint8_t>(number >> shift));
        };
        const std::size_t binary_bytes = padded.empty() ? 0 : 8 + padded.size();
        put(0x46546C67);
        put(2);
        put(12 + 8 + text.size() + binary_bytes);
        put(text.size());
        put(0x4E4F534A);
        file.insert(file.end(), text.begin(), text.end());
        if (padded.empty()) return file;
        put(padded.size());
        put(0x004E4942);
        file.insert(file.end(), padded.begin(), padded.end());
        return file;
    }

    void write_glb(const std::filesystem::path& path) const {
        const Bytes file = glb();
        write_bytes(path, file.data(), file.size());
    }
};

/// An RGBA PNG whose data is stored and not compressed, with `bits` 8 or 16. Its texels are all alike, or the
/// raw bytes are given.
class PngWriter {
public:
    static Bytes make(std::uint32_t width, std::uint32_t height, int bits, const Bytes& rows) {
        Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
        Bytes head;
        put(head, width);
        put(head, height);
        head.insert(head.end(), {static_cast<std::uint8_t>(bits), 6, 0, 0, 0});
        chunk(file, "IHDR", head);
        chunk(file, "IDAT", stored(rows));
        chunk(file, "IEND", {});
        return file;
    }

private:
    static void put(Bytes& out, std::uint32_t number) {
        for (int shift = 24; shift >= 0; shift -= 8)
            out.push_back(static_cast<std::uint8_t>(number >> shift));
    }

    static Bytes stored(const Bytes& data) {
        Bytes out = {0x78, 0x01};
        for (std::size_t at = 0; at < data.size(); at += 65535) {
            const std::size_t length = std::min<std::size_t>(65535, data.size() - at);
            out.push_back(at + length == data.size() ? 1 : 0);
            for (const std::size_t number : {length, ~length & 0xFFFFU}) {
                out.push_back(static_cast<std::uint8_t>(number));
                out.push_back(static_cast<std::uint8_t>(number >> 8U));
            }
            out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at),
                       data.begin() + static_cast<std::ptrdiff_t>(at + length));
        }
        std::uint32_t a = 1;
        std::uint32_t b = 0;
        for (const std::uint8_t byte : data) {
            a = (a + byte) % 65521;
            b = (b + a) % 65521;
        }
        put(out, b << 16U | a);
        return out;
    }

    static void chunk(Bytes& file, const char* type, const Bytes& data) {
        put(file, static_cast<std::uint32_t>(data.size()));
        Bytes checked(type, type + 4);
        checked.insert(checked.end(), data.begin(), data.end());
        std::uint32_t crc = 0xFFFFFFFF;
        for (const std::uint8_t byte : checked) {
            crc ^= byte;
            for (int bit = 0; bit < 8; ++bit)
                crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
        }
        file.insert(file.end(), checked.begin(), checked.end());
        put(file, ~crc);
    }
};

}  // namespace cairn::test

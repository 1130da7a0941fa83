#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// Limits of what a glTF file may ask for. They are far above any real scene; with them a small hostile file
/// cannot make the loader allocate without bound.
namespace cairn::scenes::gltf {

/// Bytes of JSON text, with embedded buffers.
inline constexpr std::uint64_t most_json_bytes = 1ULL << 30;
/// Values in the JSON. Each costs up to some hundred bytes while it is parsed.
inline constexpr std::size_t most_json_values = 4'000'000;
/// Nested levels of [ and {.
inline constexpr int deepest_json = 100;
/// Elements of one array: nodes, accessors, ...
inline constexpr std::size_t most_elements = 400'000;
/// Materials. tinygltf needs some kilobytes for each.
inline constexpr std::size_t most_materials = 20'000;
/// Bytes of a file. A .glb cannot be larger; a buffer or an image file must not be.
inline constexpr std::uint64_t most_file_bytes = 1ULL << 32;
/// Texels along either side of an image.
inline constexpr int widest_image = 16384;
/// Bytes of one unpacked image.
inline constexpr std::uint64_t most_image_bytes = 256ULL << 20;

/// The bytes that may still be unpacked from one file, in proportion to the bytes that were read of it. A
/// count that no honest file has is refused before anything is allocated. A small file may always unpack to
/// `floor_bytes`.
class Budget {
public:
    explicit Budget(std::uint64_t floor_bytes) : left_(floor_bytes) {}

    /// Adds what may be unpacked from so many bytes of input.
    void grant(std::uint64_t input_bytes);
    /// Takes the bytes of `count` things of `each_bytes` each.
    /// @throws Error (Fault::input) if so many bytes are not left.
    void charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes);

private:
    static constexpr std::uint64_t bytes_per_input_byte = 256;
    std::uint64_t left_;
};

/// For geometry and animation: real files unpack to some dozens of times their size.
inline constexpr std::uint64_t geometry_floor_bytes = 64ULL << 20;
/// For pictures: one of a single colour unpacks to a thousand times its size, and a scene may have many.
inline constexpr std::uint64_t picture_floor_bytes = 512ULL << 20;

}  // namespace cairn::scenes::gltf

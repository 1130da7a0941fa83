#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// What a glTF file may ask for. They stand far above any real scene; their use is that a small hostile file
/// can never make the loader allocate without bound.
namespace cairn::scenes::gltf {

/// .gltf text, embedded buffers and all.
inline constexpr std::uint64_t most_json_bytes = 1ULL << 30;
/// Each value costs up to some hundred bytes while it is parsed.
inline constexpr std::size_t most_json_values = 4'000'000;
/// Levels of [ and {.
inline constexpr int deepest_json = 100;
/// Elements of one array: nodes, accessors, ...
inline constexpr std::size_t most_elements = 400'000;
/// tinygltf holds each in kilobytes.
inline constexpr std::size_t most_materials = 20'000;
/// No .glb can be larger; nor may a buffer or an image file.
inline constexpr std::uint64_t most_file_bytes = 1ULL << 32;
/// Texels, either side.
inline constexpr int widest_image = 16384;
/// One image, unpacked.
inline constexpr std::uint64_t most_image_bytes = 256ULL << 20;

/// What may be unpacked from one file, in proportion to the bytes it was read from: counts that a file cannot
/// mean are refused here, before anything is allocated. A small file may always unpack to `floor_bytes`.
class Budget {
public:
    explicit Budget(std::uint64_t floor_bytes) : left_(floor_bytes) {}

    /// More input was read.
    void grant(std::uint64_t input_bytes);
    /// @throws Error (Fault::input) when `count` things of `each_bytes` do not fit any more.
    void charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes);

private:
    static constexpr std::uint64_t bytes_per_input_byte = 256;
    std::uint64_t left_;
};

/// Geometry and animation: real files unpack to some dozens of times their size.
inline constexpr std::uint64_t geometry_floor_bytes = 64ULL << 20;
/// Pictures: a plain one unpacks to a thousand times its size, and scenes may have many of these.
inline constexpr std::uint64_t picture_floor_bytes = 512ULL << 20;

}  // namespace cairn::scenes::gltf

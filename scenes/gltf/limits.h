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

/// What the decoded geometry, animation and images of one file may take, in proportion to the bytes it was
/// read from: real files unpack to at most some dozens of times their size, and counts that a file cannot
/// hold are refused here, before anything is allocated.
class Budget {
public:
    /// More input was read.
    void grant(std::uint64_t input_bytes);
    /// @throws Error (Fault::input) when `count` things of `each_bytes` do not fit any more.
    void charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes);

private:
    static constexpr std::uint64_t floor_bytes = 64ULL << 20;
    static constexpr std::uint64_t bytes_per_input_byte = 256;
    std::uint64_t left_ = floor_bytes;
};

}  // namespace cairn::scenes::gltf

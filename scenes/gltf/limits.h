#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// What a glTF file may ask for. They stand far above any real scene; their use is that a small hostile file
/// can never make the loader allocate without bound.
namespace cairn::scenes::gltf {

inline constexpr std::uint64_t most_json_bytes = 1ULL << 30;  ///< .gltf text, embedded buffers and all
inline constexpr std::size_t most_json_values =
    4'000'000;                                           ///< each costs up to some hundred bytes while parsed
inline constexpr int deepest_json = 100;                 ///< levels of [ and {
inline constexpr std::size_t most_elements = 1'000'000;  ///< of a top-level array: nodes, accessors, ...
inline constexpr std::uint64_t most_file_bytes =
    1ULL << 32;  ///< a .glb cannot be larger; nor may a buffer or image

inline constexpr int widest_image = 16384;                            ///< texels, either side
inline constexpr std::uint64_t most_image_bytes = 256ULL << 20;       ///< one image, unpacked
inline constexpr std::uint64_t most_image_sum_bytes = 2048ULL << 20;  ///< all images, unpacked

/// What the decoded geometry and animation of one file may take, in proportion to the bytes it was read from:
/// real files unpack to at most some dozens of times their size, and counts that a file cannot hold are
/// refused here, before anything is allocated.
class Budget {
public:
    /// More input was read.
    void grant(std::uint64_t input_bytes);
    /// @throws Error (Fault::input) when `count` things of `each_bytes` do not fit any more.
    void charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes);

private:
    static constexpr std::uint64_t floor_bytes = 512ULL << 20;
    static constexpr std::uint64_t bytes_per_input_byte = 256;
    std::uint64_t left_ = floor_bytes;
};

}  // namespace cairn::scenes::gltf

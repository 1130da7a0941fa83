#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/limits.h"
#include "scenes/gltf/source.h"

namespace cairn::scenes::gltf {

/// The bytes of buffers and buffer views, which are read and decompressed at their first use and kept: a
/// buffer that nothing uses is never opened (EXT_meshopt_compression has "fallback" buffers that hold nothing
/// at all).
class Buffers {
public:
    Buffers(const Source& source, Budget& budget) : source_(source), budget_(budget) {}

    /// The bytes of a buffer view of the file (not `no_view`), decompressed if need be.
    /// @throws Error  if its buffer is missing or too short, or the compressed data is broken.
    [[nodiscard]] std::span<const std::uint8_t> view(int index);

private:
    [[nodiscard]] std::span<const std::uint8_t> buffer(int index);
    [[nodiscard]] std::span<const std::uint8_t> range(const std::string& where, int buffer,
                                                      std::uint64_t offset, std::uint64_t length);
    [[nodiscard]] std::vector<std::uint8_t> decompressed(int view, const tinygltf::Value& compression);

    const Source& source_;
    Budget& budget_;
    std::map<int, std::vector<std::uint8_t>> loaded_;  ///< buffers outside the .glb
    std::map<int, std::vector<std::uint8_t>> decompressed_views_;
};

}  // namespace cairn::scenes::gltf

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "scenes/load.h"
#include "scenes/memory_budget.h"

/// Limits of what a glTF file may ask for, beside those of scenes/load.h. With them a small hostile file
/// cannot make the loader allocate without bound.
namespace cairn::scenes::gltf {

/// Nested levels of [ and {.
inline constexpr int deepest_json = 100;
/// Texels along either side of an image.
inline constexpr int widest_image = 16384;

/// @throws Error (Fault::input), always: the file passes a limit of scenes::Limits.
/// @param needed  what the limit must be for the file to pass
[[noreturn]] void fail_limit(const std::string& where, const std::string& what, std::uint64_t Limits::*limit,
                             std::uint64_t needed);

/// Unless the caller allows more, a small file may take so many bytes for each one that was read of it: real
/// files unpack to some dozens of times their size.
inline constexpr std::uint64_t bytes_per_input_byte = 256;

/// The bytes that may still be unpacked from one file, in proportion to the bytes that were read of it. A
/// count that no honest file has is refused before anything is allocated. A small file may always unpack to
/// `floor_bytes`. No file may unpack to more than `memory`, which several budgets share.
class Budget {
public:
    /// For `floor_bytes`: only `memory` counts.
    static constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

    /// @param what  what is unpacked, for messages: "its pictures".
    Budget(std::string what, std::uint64_t floor_bytes, MemoryBudget& memory)
        : what_(std::move(what)), left_(floor_bytes), memory_(memory) {}

    /// Adds what may be unpacked from so many bytes of input.
    void grant(std::uint64_t input_bytes);
    /// The bytes of input that were granted for.
    [[nodiscard]] std::uint64_t input_bytes() const { return input_bytes_; }
    /// Takes the bytes of `count` things of `each_bytes` each.
    /// @throws Error  Fault::input if a file of this size cannot mean so many; Fault::memory if they pass the
    ///                memory that a file may take.
    void charge(const std::string& where, std::uint64_t count, std::uint64_t each_bytes);

private:
    std::string what_;
    std::uint64_t left_;
    std::uint64_t input_bytes_ = 0;
    MemoryBudget& memory_;
};

/// For geometry and animation.
inline constexpr std::uint64_t geometry_floor_bytes = 64ULL << 20;
/// For pictures: one of a single colour unpacks to a thousand times its size, and a scene may have many.
inline constexpr std::uint64_t picture_floor_bytes = 192ULL << 20;
/// For what is placed: instances are few bytes each.
inline constexpr std::uint64_t placing_floor_bytes = 1024ULL << 20;

}  // namespace cairn::scenes::gltf

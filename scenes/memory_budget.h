#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cairn::scenes {

/// Counts bytes before they are allocated.
class MemoryBudget {
public:
    explicit MemoryBudget(std::uint64_t bytes) : limit_(bytes), left_(bytes) {}

    /// Takes the bytes of `count` things of `each_bytes` each.
    /// @param what  what takes them, for the message: "its pictures".
    /// @throws Error (Fault::memory) if so many are not left; the message says how many there were.
    void charge(const std::string& where, std::string_view what, std::uint64_t count,
                std::uint64_t each_bytes);
    [[nodiscard]] std::uint64_t left() const { return left_; }

private:
    std::uint64_t limit_;
    std::uint64_t left_;
};

}  // namespace cairn::scenes

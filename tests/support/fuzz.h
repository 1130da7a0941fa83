#pragma once

#include <cstdint>
#include <cstdlib>

namespace cairn::test {

/// Seed and number of trials of a fuzz test: for a second or two, unless the environment asks for more.
struct Fuzz {
    std::uint32_t seed;
    std::int64_t trials;
};

/// The values of CAIRN_FUZZ_SEED and CAIRN_FUZZ_TRIALS if they are set, else the defaults.
inline Fuzz fuzz_of(std::uint32_t seed, std::int64_t trials) {
    const char* const other_seed = std::getenv("CAIRN_FUZZ_SEED");
    const char* const other_trials = std::getenv("CAIRN_FUZZ_TRIALS");
    return {other_seed != nullptr ? std::uint32_t(std::atoll(other_seed)) : seed,
            other_trials != nullptr ? std::atoll(other_trials) : trials};
}

}  // namespace cairn::test

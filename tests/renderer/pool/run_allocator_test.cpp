// Runs of units: none overlaps another, none is lost, and neighbours that become free are one run again.
#include "renderer/pool/run_allocator.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/lattice_surface.h"

namespace cairn::renderer {
namespace {

struct Held {
    std::uint32_t first, units;
};

TEST(RunAllocator, RandomRunsNeverOverlapAndNoneIsLost) {
    constexpr std::uint32_t units = 1000;
    RunAllocator room(units);
    test::Random random(3);
    std::vector<Held> held;
    std::vector<bool> used(units, false);
    std::uint32_t used_units = 0;
    for (int step = 0; step < 20000; ++step) {
        if (random.between(0, 1) == 0) {
            const auto wanted = std::uint32_t(random.between(1, 60));
            const auto first = room.take(wanted);
            if (!first) {
                EXPECT_LT(room.longest_free_run(), wanted) << "step " << step;
                continue;
            }
            for (std::uint32_t unit = *first; unit < *first + wanted; ++unit) {
                ASSERT_FALSE(used.at(unit)) << "unit " << unit << " was given out twice, step " << step;
                used[unit] = true;
            }
            used_units += wanted;
            held.push_back({*first, wanted});
        } else if (!held.empty()) {
            const auto i = std::size_t(random.between(0, std::int64_t(held.size()) - 1));
            room.release(held[i].first, held[i].units);
            for (std::uint32_t unit = held[i].first; unit < held[i].first + held[i].units; ++unit)
                used[unit] = false;
            used_units -= held[i].units;
            held[i] = held.back();
            held.pop_back();
        }
        ASSERT_EQ(room.free_units(), units - used_units) << "step " << step;
    }
    for (const Held& run : held)
        room.release(run.first, run.units);
    EXPECT_EQ(room.longest_free_run(), units) << "all of it is one run again";
    EXPECT_EQ(room.take(units), 0U);
    EXPECT_FALSE(room.take(1).has_value());
}

TEST(RunAllocator, TheShortestRunThatSufficesIsTaken) {
    RunAllocator room(100);
    const std::uint32_t a = *room.take(10);
    const std::uint32_t b = *room.take(20);
    const std::uint32_t c = *room.take(30);
    EXPECT_EQ(c, 30U);
    room.release(a, 10);  // runs of 10, and of 40 at the end
    EXPECT_EQ(room.take(8), a);
    EXPECT_EQ(room.take(11), 60U);
    room.release(b, 20);
    EXPECT_EQ(room.take(22), 8U) << "2 units before it and 20 there are one run of 22";
}

}  // namespace
}  // namespace cairn::renderer

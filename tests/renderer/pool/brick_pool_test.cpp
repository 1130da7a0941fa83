// The brick pool: never more bytes than asked for, never a slot that overlaps another.
#include "renderer/pool/brick_pool.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gl/limits.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

class BrickPoolTest : public GlTest {};

void expect_within(const BrickPool& pool, int m, std::size_t bytes, const std::string& where) {
    const PoolTextures textures = textures_of(pool);
    EXPECT_LE(textures.bytes, bytes) << where;
    EXPECT_EQ(textures.bytes, pool.size_bytes()) << where << ": what it says is not what it takes";
    EXPECT_EQ(textures.color_size, textures.normal_size) << where;
    EXPECT_EQ(textures.color_size, pool.slots() * (m + 2)) << where;
    EXPECT_EQ(pool.slot_count(), pool.slots().x * pool.slots().y * pool.slots().z) << where;
}

TEST_F(BrickPoolTest, TakesNoMoreBytesThanAskedForAndLeavesFewUnused) {
    Random random(31);
    for (const int m : {8, 16, 32, 64}) {
        for (const bool has_color : {false, true}) {
            const TreeShape shape = make_tree_shape_within(4, m, 8192);
            const std::size_t slot = slot_bytes(m, has_color);
            std::vector<std::size_t> sizes;
            for (std::size_t count = 1; count <= 12; ++count)
                sizes.insert(sizes.end(), {count * slot, count * slot + slot - 1});
            for (int i = 0; i < 12; ++i)
                sizes.push_back(std::size_t(random.between(std::int64_t(slot), std::int64_t(24) << 20)));
            for (const std::size_t bytes : sizes) {
                const BrickPool pool(shape, has_color, bytes);
                const auto where = fmt::format("seed 31, M = {}, colour {}, {} bytes", m, has_color, bytes);
                expect_within(pool, m, bytes, where);
                const std::size_t most = bytes / slot;
                EXPECT_GE(std::size_t(pool.slot_count()) * 10, most * 9)
                    << where << ": " << pool.slot_count() << " slots of " << most;
            }
        }
    }
}

TEST_F(BrickPoolTest, SlotsDoNotOverlap) {
    const TreeShape shape = make_tree_shape(4, 8, 8192);
    for (const std::size_t count : {1, 7, 60, 1000}) {
        const BrickPool pool(shape, true, count * slot_bytes(8, true));
        std::vector<bool> taken(std::size_t(pool.slot_count()), false);
        for (int slot = 0; slot < pool.slot_count(); ++slot) {
            const glm::ivec3 place = pool.first_texel(slot);
            ASSERT_EQ(place % 10, glm::ivec3(0)) << "slot " << slot;
            const glm::ivec3 cell = place / 10;
            ASSERT_TRUE(glm::all(glm::lessThan(cell, pool.slots()))) << "slot " << slot << " lies outside";
            const std::size_t number =
                std::size_t(cell.x + pool.slots().x * (cell.y + pool.slots().y * cell.z));
            ASSERT_FALSE(taken[number]) << "slot " << slot << " lies on another";
            taken[number] = true;
        }
    }
}

TEST_F(BrickPoolTest, StaysWithinTheDriversTextures) {
    // More slots of 66^3 texels in a row than a texture is long.
    const int longest = gl::query_limits().texture_3d_size;
    const TreeShape shape = make_tree_shape(2, 64, 8192);
    const std::size_t bytes = std::size_t(37) * slot_bytes(64, false);  // a prime number of slots
    const BrickPool pool(shape, false, bytes);
    expect_within(pool, 64, bytes, "37 slots of M = 64");
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(pool.slots()[axis] * 66, longest) << "axis " << axis;
}

TEST_F(BrickPoolTest, SizesThatHoldNoBrickAreRefusedWithTheLeastThatDoes) {
    for (const int m : {8, 16, 32, 64}) {
        for (const bool has_color : {false, true}) {
            const TreeShape shape = make_tree_shape_within(4, m, 8192);
            const std::size_t slot = slot_bytes(m, has_color);
            for (const std::size_t bytes : {std::size_t(0), std::size_t(1), slot - 1}) {
                try {
                    const BrickPool pool(shape, has_color, bytes);
                    ADD_FAILURE() << fmt::format("M = {}, colour {}: {} bytes were accepted", m, has_color,
                                                 bytes);
                } catch (const Error& error) {
                    EXPECT_EQ(error.fault(), Fault::usage);
                    double mib = 0.0;
                    ASSERT_EQ(std::sscanf(error.way_out().c_str(), "give it at least %lf MiB", &mib), 1)
                        << error.way_out();
                    EXPECT_NO_THROW(BrickPool(shape, has_color, std::size_t(mib * 0x1p20)))
                        << "the advice does not help: " << error.way_out();
                }
            }
        }
    }
}

}  // namespace
}  // namespace cairn::renderer

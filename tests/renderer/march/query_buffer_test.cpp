// The queries of rays: their words, encoded in GLSL and decoded in C++, and the buffer that they are read
// from.
#include "renderer/march/query_buffer.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/march/march_programs.h"
#include "renderer/pool/tree_shape.h"
#include "shaders/interop/tile_query.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/probe.h"

namespace cairn::test {
namespace {

using renderer::QueryBuffer;
using renderer::QueryKind;
using renderer::Round;
using renderer::TileQueries;
using renderer::TileQuery;

constexpr std::array kinds = {QueryKind::children, QueryKind::brick, QueryKind::stand_in};

TEST(QueryWord, EveryKindOfEveryEntryHasItsOwnAndComesBack) {
    for (const std::uint32_t entries : {1U, 8U, 1000U}) {
        std::set<std::uint32_t> words;
        for (std::uint32_t entry = 0; entry < entries; ++entry) {
            for (const QueryKind kind : kinds) {
                const TileQuery query{entry, kind};
                const std::uint32_t word = renderer::query_word(query, entries);
                EXPECT_TRUE(words.insert(word).second) << "entry " << entry << " of " << entries;
                EXPECT_LT(word, 3 * entries) << "there are bits for so many";
                EXPECT_EQ(renderer::query_of_word(word, entries), query) << entry << " of " << entries;
            }
        }
    }
}

TEST(QueryWord, KnowsNothingOfTheRaysThatAsk) {
    EXPECT_EQ(renderer::query_word({7, QueryKind::brick, 12}, 100),
              renderer::query_word({7, QueryKind::brick}, 100));
}

/// The query of one ray, and the brick that it has used.
struct Asked {
    std::uint32_t entry = 0;
    std::uint32_t kind = 0;
    std::uint32_t slot = 0;
    std::uint32_t word = 0;  ///< written by the ray
};

constexpr const char* asking_shader = R"(
layout(std430, binding = 5) buffer AskedBlock { uvec4 asked[]; };
layout(local_size_x = 64) in;
uniform uint asked_count;

bool visit(inout Ray ray, Sample s) { return false; }

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= asked_count) return;
    const uint entry = asked[i].x;
    const uint kind = asked[i].y;
    asked[i].w = query_word(entry, kind);
    if (kind == uint(QUERY_CHILDREN)) query(entry, kind, int(entry % 4u));
    else if (kind == uint(QUERY_BRICK)) query(entry, kind, QUERY_RANK_BRICK);
    else ask(query_word(entry, kind));
    touch(int(asked[i].z));
}
)";

class QueryBufferTest : public GlTest {
protected:
    static constexpr std::uint32_t entries = 500;
    static constexpr int slots = 20;

    /// A pass of such rays.
    QueryBuffer::Reports pass(QueryBuffer& buffer, std::vector<Asked>& asked, Round round,
                              bool is_progressive) {
        gl::Program& program = is_progressive ? progressive_ : patient_;
        if (program.id() == 0) {
            gl::Defines defines = renderer::defines(
                {.shape = renderer::make_tree_shape(4, 8, 512), .traversal = renderer::Traversal::restart});
            for (const auto& define :
                 renderer::defines(renderer::MarchVariant{.progressive = is_progressive}))
                defines.push_back(define);
            defines.emplace_back("RAYS_WIDEN", "0");
            defines.emplace_back("VISIT_TURNS", "0");
            defines.emplace_back("FIRST_MARK_ENDS", "0");
            program = build_on_march(defines, asking_shader);
        }
        buffer.begin_frame({}, entries, slots);
        buffer.begin_pass(is_progressive);
        gl::Buffer rays = gl::Buffer::of(std::span<const Asked>(asked), "rays");
        rays.bind_storage(5);
        buffer.set(program);
        program.set("asked_count", std::uint32_t(asked.size()));
        program.set("pass_number", round.number);
        program.use();
        gl::dispatch_threads(asked.size(), 64);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        asked = rays.read_all<Asked>(asked.size());
        return buffer.read(round);
    }

    static std::vector<Asked> random_rays(int count, int kind_count, unsigned seed) {
        Random random(seed);
        std::vector<Asked> asked(std::size_t(count), Asked{});
        for (Asked& ray : asked) {
            ray.entry = std::uint32_t(random.between(0, 60)) * (entries - 1) / 60;
            ray.kind = std::uint32_t(random.between(0, kind_count - 1));
            ray.slot = std::uint32_t(random.between(0, slots / 2 - 1));
        }
        return asked;
    }

    /// Number of rays with a query, by query.
    static std::map<std::tuple<std::uint32_t, QueryKind>, std::uint32_t> count(
        const std::vector<Asked>& asked) {
        std::map<std::tuple<std::uint32_t, QueryKind>, std::uint32_t> counts;
        for (const Asked& ray : asked)
            ++counts[{ray.entry, QueryKind(ray.kind)}];
        return counts;
    }

private:
    gl::Program progressive_;
    gl::Program patient_;
};

TEST_F(QueryBufferTest, ShadersWriteTheSameWords) {
    QueryBuffer buffer(QUERY_CAPACITY, TileQueries::list, false, {});
    for (const bool is_progressive : {true, false}) {
        std::vector<Asked> asked = random_rays(300, is_progressive ? 3 : 2, 5);
        (void)pass(buffer, asked, Round{1}, is_progressive);
        for (const Asked& ray : asked)
            EXPECT_EQ(ray.word, renderer::query_word({ray.entry, QueryKind(ray.kind)}, entries))
                << "entry " << ray.entry << ", kind " << ray.kind;
    }
}

TEST_F(QueryBufferTest, TellsEachQueryOnceAndHowManyRaysAsked) {
    QueryBuffer buffer(QUERY_CAPACITY, TileQueries::list, false, {});
    std::set<std::uint32_t> ever_used;
    for (std::uint32_t number = 1; number <= 6; ++number) {
        SCOPED_TRACE(fmt::format("round {}", number));
        const bool is_progressive = number % 3 != 0;
        std::vector<Asked> asked = random_rays(400, is_progressive ? 3 : 2, number);
        const QueryBuffer::Reports reports = pass(buffer, asked, Round{number}, is_progressive);
        const auto expected = count(asked);
        EXPECT_EQ(reports.queries.size(), expected.size());
        for (const TileQuery& query : reports.queries) {
            const auto found = expected.find({query.entry, query.kind});
            ASSERT_NE(found, expected.end()) << "nobody asked for entry " << query.entry;
            EXPECT_EQ(query.rays, is_progressive ? found->second : 0U) << query.entry;
        }
        std::set<std::uint32_t> used;
        for (const Asked& ray : asked)
            used.insert(ray.slot);
        ever_used.insert(used.begin(), used.end());
        ASSERT_EQ(reports.brick_stamps.size(), std::size_t(slots));
        for (std::uint32_t slot = 0; slot < slots; ++slot) {
            if (used.contains(slot)) {
                EXPECT_EQ(reports.brick_stamps[slot], number);
            } else {
                EXPECT_LT(reports.brick_stamps[slot], number);
                EXPECT_EQ(reports.brick_stamps[slot] != 0, ever_used.contains(slot));
            }
        }
    }
}

TEST_F(QueryBufferTest, WithoutRoomOneOfEachRankIsStillKnown) {
    QueryBuffer buffer(2, TileQueries::list, false, {});
    for (unsigned seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        std::vector<Asked> asked = random_rays(300, 2, seed);
        const QueryBuffer::Reports reports = pass(buffer, asked, Round{seed}, false);
        const auto expected = count(asked);
        std::set<std::uint32_t> ranks;
        for (const TileQuery& query : reports.queries) {
            EXPECT_TRUE(expected.contains({query.entry, query.kind})) << query.entry;
            ranks.insert(query.kind == QueryKind::brick ? QUERY_RANK_BRICK : query.entry % 4);
        }
        EXPECT_EQ(ranks.size(), 5U) << "four levels of children, and bricks";
        EXPECT_LE(reports.queries.size(), 2U + 5U);
        std::vector<Asked> one(1, asked.front());
        EXPECT_EQ(pass(buffer, one, Round{seed}, false).queries.size(), 1U)
            << "the last pass was not forgotten";
    }
}

TEST_F(QueryBufferTest, RefusesACapacityOutOfRange) {
    for (const int wrong : {-1, 0, QUERY_CAPACITY + 1})
        EXPECT_THROW(QueryBuffer(wrong, TileQueries::list, false, {}), Error) << wrong;
}

}  // namespace
}  // namespace cairn::test

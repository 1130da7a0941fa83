// How rays report what they miss: in a list that may be full, or by blocks of pixels. A query that is not
// reported must be repeated, and the picture must be the same.
#include <algorithm>
#include <array>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/march/marcher.h"
#include "renderer/march/tile_blocks.h"
#include "renderer/produce/fractal_content.h"
#include "renderer/produce/surface_content.h"
#include "renderer/produce/tile_cache.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/march.h"
#include "shaders/interop/tile_query.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/test_scenes.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxel_renderer.h"
#include "voxelizer/surface/surface.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::QueryKind;
using renderer::Renderer;
using renderer::TileQueries;
using renderer::TileQuery;
using renderer::View;

// --- the reduction ---

class TileBlocksTest : public GlTest {
protected:
    /// The first few different words of a block: those of missing tiles, then those of used bricks.
    static std::vector<std::uint32_t> first_of(const std::vector<std::uint32_t>& reports,
                                               const glm::ivec2& size, const glm::ivec2& block) {
        std::vector<std::uint32_t> chosen;
        for (const bool used : {false, true}) {
            for (int y = 0; y < TILE_BLOCK_SIDE; ++y)
                for (int x = 0; x < TILE_BLOCK_SIDE; ++x) {
                    const glm::ivec2 pixel = block * TILE_BLOCK_SIDE + glm::ivec2(x, y);
                    if (pixel.x >= size.x || pixel.y >= size.y) continue;
                    const std::uint32_t word = reports[std::size_t(pixel.y * size.x + pixel.x)];
                    if (word == TILE_REPORT_NONE || ((word & TILE_REPORT_USED) != 0) != used) continue;
                    if (std::find(chosen.begin(), chosen.end(), word) != chosen.end()) continue;
                    if (chosen.size() < TILE_BLOCK_ENTRIES) chosen.push_back(word);
                }
        }
        return chosen;
    }
};

TEST_F(TileBlocksTest, EachBlockKeepsTheFirstFourDifferentTiles) {
    renderer::TileBlocks blocks({});
    Random random(31);
    for (const glm::ivec2 size : {glm::ivec2(16, 16), {1, 1}, {70, 45}, {33, 160}, {5, 40}}) {
        for (const int kinds : {1, 3, 40}) {
            SCOPED_TRACE(fmt::format("seed 31, {} x {}, {} kinds", size.x, size.y, kinds));
            blocks.begin_frame(size);
            blocks.begin_pass();
            std::vector<std::uint32_t> reports(std::size_t(size.x * size.y));
            for (std::uint32_t& word : reports) {
                const auto tile = std::uint32_t(random.between(0, kinds));
                const int kind = int(random.between(0, 9));
                word = kind < 3 ? tile : kind < 6 ? TILE_REPORT_USED | tile : TILE_REPORT_NONE;
            }
            GLint buffer = 0;
            glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, SSBO_TILE_REPORTS, &buffer);
            glNamedBufferSubData(GLuint(buffer), 0, GLsizeiptr(reports.size() * 4), reports.data());

            std::vector<std::uint32_t> queries;
            std::vector<std::uint32_t> slots;
            for (int y = 0; y * TILE_BLOCK_SIDE < size.y; ++y)
                for (int x = 0; x * TILE_BLOCK_SIDE < size.x; ++x)
                    for (const std::uint32_t word : first_of(reports, size, {x, y}))
                        if ((word & TILE_REPORT_USED) != 0) {
                            slots.push_back(word & ~TILE_REPORT_USED);
                        } else {
                            queries.push_back(word);
                        }
            std::sort(queries.begin(), queries.end());
            queries.erase(std::unique(queries.begin(), queries.end()), queries.end());
            const renderer::TileBlocks::Reports reduced = blocks.reduce();
            EXPECT_EQ(reduced.queries, queries);
            EXPECT_EQ(reduced.slots, slots);
            blocks.begin_pass();
            EXPECT_TRUE(blocks.reduce().queries.empty()) << "the last pass was not forgotten";
        }
    }
}

// --- which queries are reported if there is no room for all ---

/// A tree of a surface, a view of it from the front, and answers one at a time.
struct Scenery {
    Scenery()
        : shape_(renderer::make_tree_shape(2, 8, 512)),
          cache_(std::make_unique<renderer::SurfaceContent>(shape_, surface(), gl::ShaderSource{}),
                 {.node_bytes = 8U << 20U, .brick_bytes = 64U << 20U}) {
        const auto side = float(shape_.resolution());
        view_.eye = {0.4F * side, 0.6F * side, 1.6F * side};
        view_.pixel_cone = 0.004F;
        view_.forward = {0.0F, 0.0F, -1.0F};
        view_.right = {0.6F, 0.0F, 0.0F};
        view_.up = {0.0F, 0.6F, 0.0F};
        view_.light = {0.0F, 1.0F, 0.0F};
        view_.width = view_.height = view_.row_count = 64;
    }
    [[nodiscard]] voxelizer::Surface surface() const {
        const scenes::Scene scene = ball_over_floor();
        const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
        return voxelizer::build_surface(scene, snapshot,
                                        voxelizer::grid_around(snapshot.bounds, shape_.resolution()),
                                        {.attributes = true});
    }
    [[nodiscard]] renderer::Marcher marcher(const renderer::MarchOptions& options) const {
        return {shape_, cache_.content().channels(), options, {}};
    }
    renderer::PassResult first_pass(renderer::Marcher& marcher) const {
        marcher.begin_frame(view_, cache_.tree(), cache_.pool(), false);
        return marcher.run_pass(round_, cache_.tree(), cache_.pool());
    }
    /// Whether a query is for a brick, and its level. TileCache::answer() answers the greatest first.
    [[nodiscard]] std::tuple<bool, int> urgency(const TileQuery& query) const {
        return {query.kind == QueryKind::brick, cache_.tree().tile(query.entry).level};
    }
    [[nodiscard]] std::tuple<bool, int> most_urgent(const std::vector<TileQuery>& queries) const {
        std::tuple<bool, int> most{false, -1};
        for (const TileQuery& query : queries)
            most = std::max(most, urgency(query));
        // Any brick brings a ray to its data.
        return std::get<0>(most) ? std::tuple<bool, int>{true, 0} : most;
    }
    void answer(const TileQuery& query) {
        ASSERT_EQ(cache_.answer({&query, 1}).count(), 1U);
        cache_.upload();
    }

    renderer::TreeShape shape_;
    renderer::TileCache cache_;
    interop::MarchView view_{};
    renderer::Round round_{1};
};

class UrgentQueries : public GlTest {};

TEST_F(UrgentQueries, MostUrgentIsKnownThoughThereIsRoomForOneAlone) {
    Scenery scenery;
    renderer::Marcher all = scenery.marcher({});
    renderer::Marcher few = scenery.marcher({.query_capacity = 1});
    renderer::Marcher blocks = scenery.marcher({.tile_queries = TileQueries::blocks});
    Random random(12);
    int mixed = 0;
    for (int step = 0; step < 150; ++step) {
        SCOPED_TRACE(fmt::format("seed 12, step {}", step));
        scenery.round_ = scenery.round_.next();
        const renderer::PassResult asked = scenery.first_pass(all);
        if (asked.done()) break;
        const auto most = scenery.most_urgent(asked.queries);
        const auto least = scenery.urgency(*std::min_element(
            asked.queries.begin(), asked.queries.end(),
            [&](const TileQuery& a, const TileQuery& b) { return scenery.urgency(a) < scenery.urgency(b); }));
        mixed += !std::get<0>(least) && least != most ? 1 : 0;
        for (renderer::Marcher* lossy : {&few, &blocks}) {
            const renderer::PassResult reports = scenery.first_pass(*lossy);
            EXPECT_EQ(scenery.most_urgent(reports.queries), most);
            for (const TileQuery& query : reports.queries)
                EXPECT_EQ(std::count(asked.queries.begin(), asked.queries.end(), query), 1) << query.entry;
            EXPECT_EQ(reports.waiting_primary, asked.waiting_primary);
        }
        scenery.round_ = scenery.round_.next();
        scenery.cache_.begin_round(scenery.round_, asked.brick_stamps);
        const auto count = std::int64_t(asked.queries.size());
        scenery.answer(asked.queries[std::size_t(random.between(0, count - 1))]);
    }
    EXPECT_GT(mixed, 20) << "hardly ever was one of them more urgent than another";
}

// --- whole pictures ---

class TileQueriesTest : public GlTest {
protected:
    TileQueriesTest() : scene_(scenes::make_builtin("knot")), snapshot_(scenes::take_snapshot(scene_)) {
        view_.size.width = 101;
        view_.size.height = 70;
        view_.detail.pixel_error = 0.3;
        view_.camera = optics::framing_camera(snapshot_.bounds, 1.4);
    }
    [[nodiscard]] Renderer make(const Settings& options = {}) const {
        return voxel_renderer(scene_, snapshot_, options);
    }
    [[nodiscard]] static Settings with_blocks(Settings options = {}) {
        options.march.tile_queries = TileQueries::blocks;
        return options;
    }
    static constexpr std::size_t few_nodes = std::size_t(8) * 64 * 16;

    scenes::Scene scene_;
    scenes::Snapshot snapshot_;
    View view_;
};

TEST_F(TileQueriesTest, BlocksTellEnoughForTheSamePicture) {
    for (const int n : {2, 4}) {
        SCOPED_TRACE(n);
        const Settings options{.tree = {.n = n}, .pools = {.brick_bytes = 64U << 20U}};
        Renderer list = make(options);
        Renderer blocks = make(with_blocks(options));
        const renderer::Frame expected = list.render(view_);
        const renderer::Frame frame = blocks.render(view_);
        EXPECT_EQ(frame.image.rgba, expected.image.rgba);
        const renderer::FrameStatistics& of_list = expected.statistics;
        const renderer::FrameStatistics& of_blocks = frame.statistics;
        EXPECT_EQ(of_blocks.bricks_produced, of_list.bricks_produced) << "nothing had to go";
        EXPECT_GE(of_blocks.passes, of_list.passes);
        EXPECT_GT(of_blocks.query_bytes, 0U);
        const auto bytes_a_pass = [](const renderer::FrameStatistics& of) {
            return of.query_bytes / std::uint64_t(of.passes);
        };
        EXPECT_LT(bytes_a_pass(of_blocks), bytes_a_pass(of_list));
        EXPECT_GE(bytes_a_pass(of_list), of_list.brick_slots * 4) << "a stamp for each slot";
        blocks.forget_picture();
        const renderer::Frame blocks_frame = blocks.render(view_, {.rows = renderer::Rows{16, 40}});
        EXPECT_EQ(blocks_frame.image.rgba,
                  std::vector<std::uint8_t>(expected.image.rgba.begin() + 16 * view_.size.width * 4,
                                            expected.image.rgba.begin() + 56 * view_.size.width * 4));
        EXPECT_EQ(blocks_frame.statistics.bricks_produced, 0U);
    }
}

TEST_F(TileQueriesTest, BlocksSufficeForPoolsFarTooSmall) {
    Renderer whole = make();
    const renderer::Frame expected = whole.render(view_);
    for (const double share : {0.3, 0.02}) {
        Settings options = with_blocks();
        options.pools.brick_bytes = pool_for(expected.statistics, share);
        options.pools.node_bytes = few_nodes;
        Renderer tight = make(options);
        const renderer::Frame frame = tight.render(view_);
        EXPECT_EQ(frame.image.rgba, expected.image.rgba) << share;
        EXPECT_GT(frame.statistics.bricks_evicted, 0U);
        EXPECT_GT(frame.statistics.nodes_evicted, 0U);
    }
}

TEST_F(TileQueriesTest, BlocksServeVolumesAndConstantTiles) {
    const scenes::Volume volume = blobs(glm::ivec3(48), 3);
    View view = glowing_view(volume.bounds(), 90, 50);
    view.light.ambient = 0.3F;
    view.shadow.kind = renderer::ShadowQuality::Kind::hard;
    for (const std::size_t bytes : {std::size_t(8) << 20U, std::size_t(1) << 18U}) {
        Settings options{.tree = {.n = 2, .m = 8}, .pools = {.brick_bytes = bytes}};
        Renderer list = voxel_renderer(volume, ramp(20.0), options);
        const optics::Image expected = list.render(view).image;
        Renderer blocks = voxel_renderer(volume, ramp(20.0), with_blocks(options));
        EXPECT_EQ(blocks.render(view).image.rgba, expected.rgba) << bytes;
    }
}

TEST_F(TileQueriesTest, BlocksAndFewQueriesServeWindows) {
    Settings options{.tree = {.n = 2, .m = 16}, .pools = {.brick_bytes = 8U << 20U}};
    options.tree.max_level = 40;
    const auto make_deep = [](const Settings& deep) {
        return Renderer(renderer::fractal_content(deep.tree), deep.options());
    };
    View view;
    view.size.width = 48;
    view.size.height = 36;
    view.anchor = renderer::Tile{30, glm::i64vec3(std::int64_t(1) << 29)};
    view.camera.eye = {0.71, 0.53, 0.62};
    view.camera.target = {0.02, 0.01, 0.03};
    view.light.towards = {0.5, 0.9, 0.35};
    const optics::Image expected = make_deep(options).render(view).image;
    EXPECT_EQ(make_deep(with_blocks(options)).render(view).image.rgba, expected.rgba);
    for (const int capacity : {1, 5}) {
        Settings few = options;
        few.march.query_capacity = capacity;
        few.pools.node_bytes = std::size_t(16) << 10U;
        EXPECT_EQ(make_deep(few).render(view).image.rgba, expected.rgba) << capacity;
    }
}

TEST_F(TileQueriesTest, FewQueriesAndFewNodesEndTogether) {
    // One path of nodes from the root to a leaf and a block more, and a few bricks.
    const Settings enough{.tree = {.n = 2, .m = 8, .max_resolution = 1024},
                          .pools = {.brick_bytes = 32U << 20U}};
    Settings few = enough;
    few.pools.node_bytes = std::size_t(9) * 8 * 16;
    few.pools.brick_bytes = renderer::least_packed_bytes(renderer::tree_shape_of(few.tree), false);
    view_.size.width = 32;
    view_.size.height = 24;
    view_.detail.pixel_error = 0.5;
    const optics::Image expected = make(enough).render(view_).image;
    for (const int capacity : {1, 2, 7}) {
        few.march.query_capacity = capacity;
        Renderer renderer = make(few);
        int passes = 0;
        const renderer::Frame frame =
            renderer.render(view_, {.progress = [&](double) { ASSERT_LT(++passes, 20000) << "no end"; }});
        EXPECT_EQ(frame.image.rgba, expected.rgba) << capacity;
        EXPECT_GT(frame.statistics.nodes_evicted, 0U) << capacity;
        fmt::print("{} a pass: {} passes, {} bricks, {} nodes evicted\n", capacity, frame.statistics.passes,
                   frame.statistics.bricks_produced, frame.statistics.nodes_evicted);
    }
}

TEST_F(TileQueriesTest, FramesWithinABudgetNeedLists) {
    Renderer blocks = make(with_blocks());
    EXPECT_THROW((void)blocks.render(view_, {.budget = Milliseconds(10.0)}), Error);
    EXPECT_THROW((void)blocks.render(view_, {.rows = renderer::Rows{0, 8}, .budget = Milliseconds(10.0)}),
                 Error);
    EXPECT_THROW((void)blocks.prefetch(view_, Milliseconds(10.0)), Error);
    EXPECT_THROW((void)blocks.prefetch_finer(Milliseconds(10.0)), Error);
    EXPECT_EQ(blocks.render(view_).image.rgba, make().render(view_).image.rgba);
}

}  // namespace
}  // namespace cairn::test

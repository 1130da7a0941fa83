// The caches under stress: pools far too small, thousands of frames, sizes that change, and bricks that
// return.
#include <algorithm>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::BrickCache;
using renderer::BrickPool;
using renderer::Renderer;
using renderer::Tile;
using renderer::View;

// --- bricks in main memory ---

class BrickCacheTest : public GlTest, public ::testing::WithParamInterface<bool> {
protected:
    static constexpr int m = 8;
    static constexpr std::size_t slot_bytes(bool has_color) { return 1000 * (has_color ? 8 : 5) + 9 * 8; }

    /// Random bytes in all of a slot.
    static void scribble(const BrickPool& pool, int slot, Random& random) {
        auto noise = [&](std::size_t count) {
            std::vector<std::uint8_t> bytes(count);
            std::generate(bytes.begin(), bytes.end(), [&] { return std::uint8_t(random.between(0, 255)); });
            return bytes;
        };
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        for (const BrickPool::Layer& layer : pool.layers()) {
            const glm::ivec3 low = pool.first_texel(slot, layer.mip);
            const std::size_t texels = std::size_t(layer.side * layer.side * layer.side);
            glTextureSubImage3D(layer.texture, 0, low.x, low.y, low.z, layer.side, layer.side, layer.side,
                                layer.format, layer.type,
                                noise(texels * std::size_t(layer.texel_bytes)).data());
        }
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        const std::size_t mask_bytes = pool.mask_bytes_per_slot();
        glNamedBufferSubData(pool.masks().id(), GLintptr(std::size_t(slot) * mask_bytes),
                             GLsizeiptr(mask_bytes), noise(mask_bytes).data());
    }
    static Tile tile(int i) { return {3, {i, 2 * i, 5}}; }
    /// Random bytes in all slots of the pool leave it and return, each to another slot.
    static void expect_bricks_back(const renderer::TreeShape& shape, BrickPool pool);
};

void BrickCacheTest::expect_bricks_back(const renderer::TreeShape& shape, BrickPool pool) {
    BrickCache cache(shape, pool, std::size_t(1) << 20U);
    Random random(8);
    std::vector<std::vector<std::uint8_t>> bricks;
    std::vector<renderer::Tree::EvictedBrick> evicted;
    for (int slot = 0; slot < pool.slot_count(); ++slot) {
        scribble(pool, slot, random);
        bricks.push_back(slot_content(pool, slot));
        evicted.push_back({tile(slot), slot});
    }
    cache.store(evicted);
    for (int slot = 0; slot < pool.slot_count(); ++slot)
        scribble(pool, slot, random);
    const int last = pool.slot_count() - 1;
    for (int slot = 0; slot <= last; ++slot) {
        const std::vector<std::uint8_t> neighbour = slot_content(pool, slot);
        ASSERT_EQ(cache.restore(tile(slot), last - slot), BrickCache::Restored::yes) << "slot " << slot;
        EXPECT_EQ(slot_content(pool, last - slot), bricks[std::size_t(slot)]) << "slot " << slot;
        if (slot != last - slot) {
            EXPECT_EQ(slot_content(pool, slot), neighbour) << "it wrote past its slot";
        }
    }
    EXPECT_EQ(cache.restore(tile(1000), 0), BrickCache::Restored::not_cached);
    EXPECT_EQ(cache.counters().stored, bricks.size());
    EXPECT_EQ(cache.counters().restored, bricks.size());
}

TEST_P(BrickCacheTest, BrickComesBackBitForBitInAnotherSlot) {
    const renderer::TreeShape shape = renderer::make_tree_shape(2, m, 64);
    expect_bricks_back(shape, BrickPool(shape, GetParam(), 60 * slot_bytes(GetParam())));
}

TEST_P(BrickCacheTest, BrickComesBackWithItsMips) {
    for (const int n : {2, 4, 8}) {
        SCOPED_TRACE(n);
        const renderer::TreeShape shape = renderer::make_tree_shape(n, m, 64, true);
        expect_bricks_back(shape, BrickPool(shape, GetParam(), 60 * slot_bytes(GetParam())));
    }
}

TEST_P(BrickCacheTest, KeepsWithinItsBytesWhatWasUsedLast) {
    const renderer::TreeShape shape = renderer::make_tree_shape(2, m, 64);
    BrickPool pool(shape, GetParam(), 4 * slot_bytes(GetParam()));
    const std::size_t limit = 10 * (slot_bytes(GetParam()) + 200);
    BrickCache cache(shape, pool, limit);
    for (int i = 0; i < 100; ++i) {
        const renderer::Tree::EvictedBrick evicted{tile(i), 0};
        cache.store({&evicted, 1});
        EXPECT_EQ(cache.restore(tile(0), 1), BrickCache::Restored::yes)
            << "tile 0 is used all the time, " << i;
        EXPECT_LE(cache.size_bytes(), limit);
    }
    EXPECT_EQ(cache.restore(tile(99), 0), BrickCache::Restored::yes);
    EXPECT_EQ(cache.restore(tile(1), 0), BrickCache::Restored::not_cached) << "not used for longest";
    EXPECT_GT(cache.size_bytes(), 8 * slot_bytes(GetParam()));
    EXPECT_THROW(BrickCache(shape, pool, 100), Error);
}

INSTANTIATE_TEST_SUITE_P(Color, BrickCacheTest, ::testing::Bool(),
                         [](const auto& color) { return color.param ? "Color" : "NoColor"; });

// --- whole frames ---

class CacheStability : public GlTest {
protected:
    CacheStability() : scene_(scenes::make_builtin("knot")), snapshot_(scenes::take_snapshot(scene_)) {
        view_.size.width = 96;
        view_.size.height = 72;
        view_.detail.pixel_error = 0.15;
        view_.camera = optics::framing_camera(snapshot_.bounds, 4.0 / 3.0);
        behind_ = view_;
        behind_.camera.eye = 2.0 * view_.camera.target - view_.camera.eye;
    }
    [[nodiscard]] Renderer make(const Settings& options = {}) const {
        return voxel_renderer(scene_, snapshot_, options);
    }
    /// Settings with a pool for a share of the view's bricks, and for as few nodes as possible.
    [[nodiscard]] Settings share_of(double share, const View& view) const {
        Renderer fresh = make();
        const renderer::Frame frame = fresh.render(view);
        Settings options;
        options.pools.brick_bytes = pool_for(frame.statistics, share);
        options.pools.node_bytes = std::size_t(8) * 64 * 16;
        return options;
    }

    scenes::Scene scene_;
    scenes::Snapshot snapshot_;
    View view_;
    View behind_;
};

TEST_F(CacheStability, PoolsOfATwentiethOfTheViewEndWithTheSamePicture) {
    const optics::Image expected = make().render(view_).image;
    Settings options = share_of(0.05, view_);
    for (const std::size_t cache_bytes : {std::size_t(0), std::size_t(1) << 20U, std::size_t(64) << 20U}) {
        options.pools.cache_bytes = cache_bytes;
        Renderer tight = make(options);
        const renderer::Frame frame = tight.render(view_);
        EXPECT_EQ(frame.image.rgba, expected.rgba) << cache_bytes;
        EXPECT_GT(frame.statistics.bricks_evicted, 0U);
        (void)tight.render(behind_, {.budget = Milliseconds(0.0)});
        const renderer::Frame tight_frame = tight.render(view_);
        EXPECT_EQ(tight_frame.image.rgba, expected.rgba) << cache_bytes << ", after another view";
        EXPECT_LE(tight_frame.statistics.brick_cache_bytes, cache_bytes);
    }
}

TEST_F(CacheStability, CachedBricksAreRestoredInsteadOfProduced) {
    Settings options = share_of(0.2, view_);
    options.pools.node_bytes = renderer::PoolSizes().node_bytes;
    options.pools.cache_bytes = std::size_t(256) << 20U;
    Renderer renderer = make(options);
    const renderer::Frame first = renderer.render(view_);
    EXPECT_GT(first.statistics.bricks_cached, 0U);
    EXPECT_GT(first.statistics.brick_cache_bytes, 0U);
    renderer.forget_picture();
    const renderer::Frame second = renderer.render(view_);
    EXPECT_EQ(second.image.rgba, first.image.rgba);
    EXPECT_EQ(second.statistics.bricks_produced, 0U) << "all of them were in main memory";
    EXPECT_GT(second.statistics.bricks_restored, 100U);
    EXPECT_EQ(first.image.rgba, make().render(view_).image.rgba);
}

TEST_F(CacheStability, BricksOfEvictedNodesAreLinkedAgain) {
    Settings options;
    options.pools.node_bytes = std::size_t(8) * 64 * 16;
    Renderer renderer = make(options);
    const renderer::Frame first = renderer.render(view_);
    EXPECT_GT(first.statistics.nodes_evicted, 0U);
    renderer.forget_picture();
    const renderer::Frame frame = renderer.render(view_);
    EXPECT_EQ(frame.image.rgba, first.image.rgba);
    EXPECT_EQ(frame.statistics.bricks_produced, 0U) << "all of them were in the pool";
    EXPECT_GT(frame.statistics.bricks_relinked, 0U);
    EXPECT_EQ(first.image.rgba, make().render(view_).image.rgba);
}

TEST_F(CacheStability, StaticCameraMarchesNothing) {
    Renderer renderer = make();
    const renderer::Frame first = renderer.render(view_);
    EXPECT_GT(first.statistics.passes, 0);
    const auto expect_known = [&](const renderer::Frame& known, const char* what) {
        EXPECT_EQ(known.image.rgba, first.image.rgba) << what;
        EXPECT_EQ(known.statistics.passes, 0) << what;
        EXPECT_EQ(known.statistics.bricks_produced, 0U) << what;
        EXPECT_TRUE(known.statistics.converged) << what;
        EXPECT_GT(known.statistics.bricks_resident, 0U) << what;
    };
    expect_known(renderer.render(view_), "the same view");
    expect_known(renderer.render(view_, {.budget = Milliseconds(0.0)}), "within a budget");
    expect_known(renderer.render(view_, {.rows = renderer::Rows{0, view_.size.height}}), "all rows");
    const renderer::Frame rows =
        renderer.render(view_, {.rows = renderer::Rows{30, 9}, .budget = Milliseconds(0.0)});
    EXPECT_EQ(rows.statistics.passes, 0);
    EXPECT_EQ(rows.image.height, 9);
    EXPECT_TRUE(std::equal(rows.image.rgba.begin(), rows.image.rgba.end(),
                           first.image.rgba.begin() + 30 * view_.size.width * 4));

    View changed = view_;
    changed.light.ambient = 0.5F;
    const renderer::Frame frame = renderer.render(changed);
    EXPECT_EQ(frame.image.rgba, make().render(changed).image.rgba);
    EXPECT_GT(frame.statistics.passes, 0) << "the light changed";
    // After some rows of a picture the whole of it is not known.
    (void)renderer.render(view_, {.rows = renderer::Rows{0, 40}});
    const renderer::Frame last = renderer.render(view_);
    EXPECT_EQ(last.image.rgba, first.image.rgba);
    EXPECT_GT(last.statistics.passes, 0);
    renderer.forget_picture();
    const renderer::Frame again = renderer.render(view_);
    EXPECT_EQ(again.image.rgba, first.image.rgba);
    EXPECT_GT(again.statistics.passes, 0);
}

TEST_F(CacheStability, UnfinishedPictureIsNotKept) {
    Renderer renderer = make();
    const renderer::Frame frame = renderer.render(view_, {.budget = Milliseconds(0.0)});
    ASSERT_FALSE(frame.statistics.converged);
    const renderer::Frame last = renderer.render(view_);
    EXPECT_EQ(last.image.rgba, make().render(view_).image.rgba);
    EXPECT_GT(last.statistics.passes, 0);
}

TEST_F(CacheStability, EmptyScenesBackgroundIsThatOfOthers) {
    scenes::Scene nothing;
    nothing.scenes.resize(1);
    Renderer empty = voxel_renderer(nothing, scenes::take_snapshot(nothing));
    Renderer knot = make();
    View away = view_;
    away.camera.target = 2.0 * away.camera.eye - away.camera.target;
    const View with_margin = view_;  // whose corner shows the background
    for (View view : {away, with_margin}) {
        for (int i = 0; i < 20; ++i) {
            view.background = glm::vec3(float(i) / 16.0F, 0.003F * float(i), 1.0F - 0.045F * float(i));
            const renderer::Frame ours = empty.render(view);
            const renderer::Frame marched = knot.render(view);
            EXPECT_EQ(ours.statistics.passes, 0);
            EXPECT_EQ(marched.statistics.passes > 0, view.camera == with_margin.camera);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_LE(std::abs(int(ours.image.rgba[k]) - int(marched.image.rgba[k])), 1)
                    << i << ", channel " << k;
            EXPECT_EQ(ours.image.rgba.size(), marched.image.rgba.size());
        }
    }
}

TEST_F(CacheStability, MoreQuestionsThanThereIsRoomForAreAskedAgain) {
    const optics::Image expected = make().render(view_).image;
    for (const int capacity : {3, 65536}) {
        Settings options;
        options.march.query_capacity = capacity;
        Renderer renderer = make(options);
        const renderer::Frame frame = renderer.render(view_);
        EXPECT_EQ(frame.image.rgba, expected.rgba) << capacity;
        if (capacity == 3) {
            // One more a pass, because the most urgent of those without room is known.
            EXPECT_GE(std::uint64_t(frame.statistics.passes) * 4, frame.statistics.bricks_produced)
                << "a pass asked for more";
        }
    }
    for (const int wrong : {0, -1, 65537})
        EXPECT_THROW((void)make({.march = {.query_capacity = wrong}}), Error) << wrong;
}

TEST_F(CacheStability, PrefetchedBricksAreFoundByTheNextFrames) {
    constexpr int frames = 8;
    auto camera_at = [&](int frame) {
        View view = view_;
        view.detail.pixel_error = 0.5;
        view.camera.eye = glm::mix(view_.camera.eye, view_.camera.target, 0.07 * frame);
        return view;
    };
    Renderer plain = make();
    Renderer ahead = make();
    std::uint64_t produced = 0;
    std::uint64_t produced_late = 0;
    std::uint64_t prefetched = 0;
    (void)plain.render(camera_at(0), {.budget = Milliseconds(1e9)});
    (void)ahead.render(camera_at(0), {.budget = Milliseconds(1e9)});
    for (int frame = 1; frame < frames; ++frame) {
        View next = camera_at(frame);
        if (frame > 1)
            next.camera = optics::extrapolated(camera_at(frame - 2).camera, camera_at(frame - 1).camera);
        const std::uint64_t done = ahead.prefetch(next, Milliseconds(1e6));
        const renderer::Frame expected = plain.render(camera_at(frame), {.budget = Milliseconds(1e9)});
        produced += expected.statistics.bricks_produced;
        const renderer::Frame ahead_frame = ahead.render(camera_at(frame), {.budget = Milliseconds(1e9)});
        EXPECT_EQ(ahead_frame.image.rgba, expected.image.rgba) << "frame " << frame;
        produced_late += ahead_frame.statistics.bricks_produced;
        EXPECT_EQ(ahead_frame.statistics.bricks_prefetched, done);
        prefetched += done;
    }
    fmt::print("{} bricks produced in frames without, {} with prefetching, {} ahead\n", produced,
               produced_late, prefetched);
    EXPECT_GT(produced, 50U) << "the camera found nothing new";
    EXPECT_LE(produced_late * 2, produced);
}

TEST_F(CacheStability, PrefetchTakesNothingFromTheFrameBeforeIt) {
    Settings options;
    Renderer fresh = make();
    const renderer::Frame frame = fresh.render(view_, {.budget = Milliseconds(1e9)});
    options.pools.brick_bytes = pool_for(frame.statistics, 1.3);
    Renderer renderer = make(options);
    const renderer::Frame before = renderer.render(view_, {.budget = Milliseconds(1e9)});
    ASSERT_TRUE(before.statistics.converged);
    (void)renderer.prefetch(behind_, Milliseconds(1e6));
    renderer.forget_picture();
    const renderer::Frame last = renderer.render(view_, {.budget = Milliseconds(1e9)});
    EXPECT_EQ(last.image.rgba, before.image.rgba);
    EXPECT_EQ(last.statistics.bricks_produced, 0U);
    EXPECT_EQ(renderer.prefetch(behind_, Milliseconds(0.0)), 0U) << "there was no time";
    EXPECT_THROW((void)renderer.prefetch(behind_, Milliseconds(-1.0)), Error);
}

std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0;
    std::size_t resident = 0;
    statm >> total >> resident;
    return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

/// The number of names that OpenGL holds.
std::size_t gl_objects() {
    std::size_t count = 0;
    for (GLuint name = 1; name < 4096; ++name) {
        for (const bool lives : {glIsBuffer(name) == GL_TRUE, glIsTexture(name) == GL_TRUE,
                                 glIsProgram(name) == GL_TRUE, glIsShader(name) == GL_TRUE})
            count += lives ? 1 : 0;
    }
    return count;
}

/// A camera around the scene or in it, which looks at some point of it.
View random_view(const View& like, const scenes::Bounds& bounds, Random& random) {
    auto unit = [&] { return double(random.between(0, 1000)) / 1000.0; };
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    const glm::dvec3 size = bounds.high - bounds.low;
    View view = like;
    view.camera.eye = centre + size * (glm::dvec3(unit(), unit(), unit()) - 0.5) * 2.5;
    view.camera.target = centre + size * (glm::dvec3(unit(), unit(), unit()) - 0.5) * 0.5 + 1e-3;
    return view;
}

TEST_F(CacheStability, TenThousandFramesOfRandomFlightLeaveNothingBehind) {
    constexpr int frames = 10000;
    constexpr int warm_up = 2500;
    constexpr std::size_t most_growth = std::size_t(24) << 20U;
    const scenes::Scene scene = ball_over_floor();
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    View view;
    view.size.width = 16;
    view.size.height = 12;
    Settings options{.tree = {.max_resolution = 1024}};
    options.pools.brick_bytes = std::size_t(128) << 10U;  // of the megabyte that a view needs
    options.pools.node_bytes = std::size_t(12) * 64 * 16;
    options.pools.cache_bytes = std::size_t(2) << 20U;
    Renderer renderer = voxel_renderer(scene, snapshot, options);
    Random random(77);
    std::size_t objects = 0;
    std::size_t bytes = 0;
    std::uint64_t evicted = 0;
    for (int frame = 0; frame < frames; ++frame) {
        SCOPED_TRACE(fmt::format("seed 77, frame {}", frame));
        const View next = random_view(view, snapshot.bounds, random);
        const renderer::Request patient;
        const renderer::Request hasty{.budget = Milliseconds(0.0)};
        const renderer::FrameStatistics statistics =
            renderer.render(next, frame % 5 == 0 ? patient : hasty).statistics;
        evicted += statistics.bricks_evicted;
        ASSERT_LE(statistics.brick_cache_bytes, options.pools.cache_bytes);
        if (frame != warm_up) continue;
        objects = gl_objects();
        bytes = resident_bytes();
    }
    EXPECT_GT(evicted, 1000U) << "the pools were not exhausted";
    EXPECT_EQ(gl_objects(), objects);
    EXPECT_LE(resident_bytes(), bytes + most_growth);
    const View last = random_view(view, snapshot.bounds, random);
    EXPECT_EQ(renderer.render(last).image.rgba,
              voxel_renderer(scene, snapshot, {.tree = {.max_resolution = 1024}}).render(last).image.rgba);
}

TEST_F(CacheStability, SizesMayChangeWithEveryFrame) {
    Renderer renderer = make();
    Renderer fresh = make();
    Random random(5);
    for (int frame = 0; frame < 40; ++frame) {
        View view = view_;
        view.detail.pixel_error = 1.0;
        view.size.width = int(random.between(1, 150));
        view.size.height = int(random.between(1, 150));
        const renderer::Frame ours =
            frame % 3 == 0 ? renderer.render(view)
                           : renderer.render(view, {.budget = Milliseconds(frame % 3 == 1 ? 0.0 : 1e9)});
        EXPECT_EQ(ours.image.rgba.size(), std::size_t(view.size.width) * std::size_t(view.size.height) * 4);
        if (!ours.statistics.converged) continue;
        fresh.forget_picture();
        EXPECT_EQ(ours.image.rgba, fresh.render(view).image.rgba)
            << "seed 5, frame " << frame << ": " << view.size.width << " x " << view.size.height;
    }
}

}  // namespace
}  // namespace cairn::test

// The caches under stress: pools far too small, thousands of frames, sizes that change, and what comes back.
#include <algorithm>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/renderer.h"
#include "scenes/builtin/builtin.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/test_scenes.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::BrickCache;
using renderer::BrickPool;
using renderer::Renderer;
using renderer::Tile;
using renderer::TreeOptions;
using renderer::View;

// --- bricks in main memory ---

class BrickCacheTest : public GlTest, public ::testing::WithParamInterface<bool> {
protected:
    static constexpr int m = 8;
    static constexpr std::size_t slot_bytes(bool has_color) { return 1000 * (has_color ? 8 : 5) + 9 * 8; }

    /// All bytes of a slot, layer by layer, then its masks.
    static std::vector<std::uint8_t> read(const BrickPool& pool, int slot) {
        std::vector<std::uint8_t> bytes;
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        for (const BrickPool::Layer& layer : pool.layers()) {
            const glm::ivec3 low = pool.first_texel(slot, layer.mip);
            const int size = layer.side * layer.side * layer.side * layer.texel_bytes;
            bytes.resize(bytes.size() + std::size_t(size));
            glGetTextureSubImage(layer.texture, 0, low.x, low.y, low.z, layer.side, layer.side, layer.side,
                                 layer.format, layer.type, size, &bytes[bytes.size() - std::size_t(size)]);
        }
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        const std::size_t mask_bytes = pool.mask_bytes_a_slot();
        const std::vector<std::uint8_t> masks =
            pool.masks().read_all<std::uint8_t>(mask_bytes, std::size_t(slot) * mask_bytes);
        bytes.insert(bytes.end(), masks.begin(), masks.end());
        return bytes;
    }
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
        const std::size_t mask_bytes = pool.mask_bytes_a_slot();
        glNamedBufferSubData(pool.masks().id(), GLintptr(std::size_t(slot) * mask_bytes),
                             GLsizeiptr(mask_bytes), noise(mask_bytes).data());
    }
    static Tile tile(int i) { return {3, {i, 2 * i, 5}}; }
    /// Random bytes in all slots of the pool leave it and come back, each to another slot.
    static void expect_bricks_back(const BrickPool& pool);
};

void BrickCacheTest::expect_bricks_back(const BrickPool& pool) {
    BrickCache cache(pool, std::size_t(1) << 20U);
    Random random(8);
    std::vector<std::vector<std::uint8_t>> bricks;
    std::vector<renderer::Tree::Evicted> evicted;
    for (int slot = 0; slot < pool.slot_count(); ++slot) {
        scribble(pool, slot, random);
        bricks.push_back(read(pool, slot));
        evicted.push_back({tile(slot), slot});
    }
    cache.store(evicted);
    for (int slot = 0; slot < pool.slot_count(); ++slot)
        scribble(pool, slot, random);
    const int last = pool.slot_count() - 1;
    for (int slot = 0; slot <= last; ++slot) {
        const std::vector<std::uint8_t> neighbour = read(pool, slot);
        ASSERT_TRUE(cache.restore(tile(slot), last - slot)) << "slot " << slot;
        EXPECT_EQ(read(pool, last - slot), bricks[std::size_t(slot)]) << "slot " << slot;
        if (slot != last - slot) {
            EXPECT_EQ(read(pool, slot), neighbour) << "it wrote past its slot";
        }
    }
    EXPECT_FALSE(cache.restore(tile(1000), 0));
    EXPECT_EQ(cache.counters().stored, bricks.size());
    EXPECT_EQ(cache.counters().restored, bricks.size());
}

TEST_P(BrickCacheTest, BrickComesBackBitForBitInAnotherSlot) {
    const BrickPool pool(renderer::make_tree_shape(2, m, 64), GetParam(), 60 * slot_bytes(GetParam()));
    expect_bricks_back(pool);
}

TEST_P(BrickCacheTest, BrickComesBackWithItsMips) {
    for (const int n : {2, 4, 8}) {
        SCOPED_TRACE(n);
        const renderer::TreeShape shape = renderer::make_tree_shape(n, m, 64, true);
        expect_bricks_back(BrickPool(shape, GetParam(), 60 * slot_bytes(GetParam())));
    }
}

TEST_P(BrickCacheTest, KeepsWithinItsBytesWhatWasUsedLast) {
    const BrickPool pool(renderer::make_tree_shape(2, m, 64), GetParam(), 4 * slot_bytes(GetParam()));
    const std::size_t limit = 10 * (slot_bytes(GetParam()) + 200);
    BrickCache cache(pool, limit);
    for (int i = 0; i < 100; ++i) {
        const renderer::Tree::Evicted evicted{tile(i), 0};
        cache.store({&evicted, 1});
        EXPECT_TRUE(cache.restore(tile(0), 1)) << "tile 0 is used all the time, " << i;
        EXPECT_LE(cache.size_bytes(), limit);
    }
    EXPECT_TRUE(cache.restore(tile(99), 0));
    EXPECT_FALSE(cache.restore(tile(1), 0)) << "not used for longest";
    EXPECT_GE(cache.brick_count(), 8U);
    EXPECT_THROW(BrickCache(pool, 100), Error);
}

INSTANTIATE_TEST_SUITE_P(Color, BrickCacheTest, ::testing::Bool(),
                         [](const auto& color) { return color.param ? "Color" : "NoColor"; });

// --- whole frames ---

class CacheStability : public GlTest {
protected:
    CacheStability() : scene_(scenes::make_builtin("knot")), snapshot_(scenes::take_snapshot(scene_)) {
        view_.width = 96;
        view_.height = 72;
        view_.pixel_error = 0.15;
        view_.camera = optics::framing_camera(snapshot_.bounds, 4.0 / 3.0);
        behind_ = view_;
        behind_.camera.eye = 2.0 * view_.camera.target - view_.camera.eye;
    }
    [[nodiscard]] Renderer make(const TreeOptions& options = {}) const {
        return Renderer(scene_, snapshot_, options);
    }
    /// A pool of a share of the bricks that the view needs, and as few nodes as can be.
    [[nodiscard]] TreeOptions share_of(double share, const View& view) const {
        Renderer fresh = make();
        (void)fresh.render(view);
        TreeOptions options;
        options.brick_pool_bytes =
            std::size_t(std::max(1.0, double(fresh.statistics().bricks_produced) * share)) * slot_bytes;
        options.node_pool_bytes = std::size_t(8) * 64 * 16;
        return options;
    }

    static constexpr std::size_t slot_bytes = 18 * 18 * 18 * 5 + 65 * 8;  // the knot has one colour
    scenes::Scene scene_;
    scenes::Snapshot snapshot_;
    View view_;
    View behind_;
};

TEST_F(CacheStability, PoolsOfATwentiethOfTheViewEndWithTheSamePicture) {
    const optics::Image expected = make().render(view_);
    TreeOptions options = share_of(0.05, view_);
    for (const std::size_t cache_bytes : {std::size_t(0), std::size_t(1) << 20U, std::size_t(64) << 20U}) {
        options.brick_cache_bytes = cache_bytes;
        Renderer tight = make(options);
        EXPECT_EQ(tight.render(view_).rgba, expected.rgba) << cache_bytes;
        EXPECT_GT(tight.statistics().bricks_evicted, 0U);
        (void)tight.render_within(behind_, 0.0);
        EXPECT_EQ(tight.render(view_).rgba, expected.rgba) << cache_bytes << ", after another view";
        EXPECT_LE(tight.statistics().brick_cache_bytes, cache_bytes);
    }
}

TEST_F(CacheStability, CachedBricksAreRestoredInsteadOfProduced) {
    TreeOptions options;
    options.brick_pool_bytes = 40 * slot_bytes;
    options.brick_cache_bytes = std::size_t(256) << 20U;
    Renderer renderer = make(options);
    const optics::Image first = renderer.render(view_);
    EXPECT_GT(renderer.statistics().bricks_cached, 0U);
    EXPECT_GT(renderer.statistics().brick_cache_bytes, 0U);
    renderer.forget_picture();
    const optics::Image second = renderer.render(view_);
    EXPECT_EQ(second.rgba, first.rgba);
    EXPECT_EQ(renderer.statistics().bricks_produced, 0U) << "all of them were in main memory";
    EXPECT_GT(renderer.statistics().bricks_restored, 100U);
    EXPECT_EQ(first.rgba, make().render(view_).rgba);
}

TEST_F(CacheStability, BricksOfEvictedNodesAreLinkedAgain) {
    TreeOptions options;
    options.node_pool_bytes = std::size_t(8) * 64 * 16;
    Renderer renderer = make(options);
    const optics::Image first = renderer.render(view_);
    EXPECT_GT(renderer.statistics().nodes_evicted, 0U);
    renderer.forget_picture();
    EXPECT_EQ(renderer.render(view_).rgba, first.rgba);
    EXPECT_EQ(renderer.statistics().bricks_produced, 0U) << "all of them were in the pool";
    EXPECT_GT(renderer.statistics().bricks_relinked, 0U);
    EXPECT_EQ(first.rgba, make().render(view_).rgba);
}

TEST_F(CacheStability, StaticCameraMarchesNothing) {
    Renderer renderer = make();
    const optics::Image first = renderer.render(view_);
    EXPECT_GT(renderer.statistics().passes, 0);
    const auto expect_known = [&](const optics::Image& image, const char* what) {
        EXPECT_EQ(image.rgba, first.rgba) << what;
        EXPECT_EQ(renderer.statistics().passes, 0) << what;
        EXPECT_EQ(renderer.statistics().bricks_produced, 0U) << what;
        EXPECT_TRUE(renderer.statistics().converged) << what;
        EXPECT_GT(renderer.statistics().bricks_resident, 0U) << what;
    };
    expect_known(renderer.render(view_), "the same view");
    expect_known(renderer.render_within(view_, 0.0), "within a budget");
    expect_known(renderer.render_rows(view_, {0, view_.height}), "all rows");
    const optics::Image rows = renderer.render_rows_within(view_, {30, 9}, 0.0);
    EXPECT_EQ(renderer.statistics().passes, 0);
    EXPECT_EQ(rows.height, 9);
    EXPECT_TRUE(std::equal(rows.rgba.begin(), rows.rgba.end(), first.rgba.begin() + 30 * view_.width * 4));

    View changed = view_;
    changed.light.ambient = 0.5F;
    EXPECT_EQ(renderer.render(changed).rgba, make().render(changed).rgba);
    EXPECT_GT(renderer.statistics().passes, 0) << "the light changed";
    // Some rows of a picture do not make the whole of it known.
    (void)renderer.render_rows(view_, {0, 40});
    EXPECT_EQ(renderer.render(view_).rgba, first.rgba);
    EXPECT_GT(renderer.statistics().passes, 0);
    renderer.forget_picture();
    EXPECT_EQ(renderer.render(view_).rgba, first.rgba);
    EXPECT_GT(renderer.statistics().passes, 0);
}

TEST_F(CacheStability, UnfinishedPictureIsNotKept) {
    Renderer renderer = make();
    (void)renderer.render_within(view_, 0.0);
    ASSERT_FALSE(renderer.statistics().converged);
    EXPECT_EQ(renderer.render(view_).rgba, make().render(view_).rgba);
    EXPECT_GT(renderer.statistics().passes, 0);
}

TEST_F(CacheStability, EmptyScenesBackgroundIsThatOfOthers) {
    scenes::Scene nothing;
    nothing.scenes.resize(1);
    Renderer empty(nothing, scenes::take_snapshot(nothing));
    Renderer knot = make();
    View away = view_;
    away.camera.target = 2.0 * away.camera.eye - away.camera.target;
    for (int i = 0; i < 20; ++i) {
        away.background = glm::vec3(float(i) / 16.0F, 0.003F * float(i), 1.0F - 0.045F * float(i));
        const optics::Image ours = empty.render(away);
        const optics::Image marched = knot.render(away);
        EXPECT_EQ(empty.statistics().passes, 0);
        EXPECT_GT(knot.statistics().passes, 0);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_LE(std::abs(int(ours.rgba[k]) - int(marched.rgba[k])), 1) << i << ", channel " << k;
        EXPECT_EQ(ours.rgba.size(), marched.rgba.size());
    }
}

TEST_F(CacheStability, MoreQuestionsThanThereIsRoomForAreAskedAgain) {
    const optics::Image expected = make().render(view_);
    for (const int capacity : {3, 65536}) {
        TreeOptions options;
        options.query_capacity = capacity;
        Renderer renderer = make(options);
        EXPECT_EQ(renderer.render(view_).rgba, expected.rgba) << capacity;
        if (capacity == 3) {
            // One more a pass, because the most urgent of those without room is known.
            EXPECT_GE(std::uint64_t(renderer.statistics().passes) * 4, renderer.statistics().bricks_produced)
                << "a pass asked for more";
        }
    }
    for (const int wrong : {0, -1, 65537})
        EXPECT_THROW((void)make({.query_capacity = wrong}), Error) << wrong;
}

TEST_F(CacheStability, PrefetchedBricksAreFoundByTheNextFrames) {
    constexpr int frames = 8;
    auto camera_at = [&](int frame) {
        View view = view_;
        view.pixel_error = 0.5;
        view.camera.eye = glm::mix(view_.camera.eye, view_.camera.target, 0.07 * frame);
        return view;
    };
    Renderer plain = make();
    Renderer ahead = make();
    std::uint64_t produced = 0;
    std::uint64_t produced_late = 0;
    std::uint64_t prefetched = 0;
    (void)plain.render_within(camera_at(0), 1e9);
    (void)ahead.render_within(camera_at(0), 1e9);
    for (int frame = 1; frame < frames; ++frame) {
        View next = camera_at(frame);
        if (frame > 1)
            next.camera = optics::extrapolated(camera_at(frame - 2).camera, camera_at(frame - 1).camera);
        const std::uint64_t done = ahead.prefetch(next, 1e6);
        const optics::Image expected = plain.render_within(camera_at(frame), 1e9);
        produced += plain.statistics().bricks_produced;
        EXPECT_EQ(ahead.render_within(camera_at(frame), 1e9).rgba, expected.rgba) << "frame " << frame;
        produced_late += ahead.statistics().bricks_produced;
        EXPECT_EQ(ahead.statistics().bricks_prefetched, done);
        prefetched += done;
    }
    fmt::print("{} bricks produced in frames without, {} with prefetching, {} ahead\n", produced,
               produced_late, prefetched);
    EXPECT_GT(produced, 50U) << "the camera found nothing new";
    EXPECT_LE(produced_late * 2, produced);
}

TEST_F(CacheStability, PrefetchTakesNothingFromTheFrameBeforeIt) {
    TreeOptions options;
    Renderer fresh = make();
    (void)fresh.render_within(view_, 1e9);
    options.brick_pool_bytes = (fresh.statistics().bricks_resident + 30) * slot_bytes;
    Renderer renderer = make(options);
    const optics::Image before = renderer.render_within(view_, 1e9);
    ASSERT_TRUE(renderer.statistics().converged);
    (void)renderer.prefetch(behind_, 1e6);
    renderer.forget_picture();
    EXPECT_EQ(renderer.render_within(view_, 1e9).rgba, before.rgba);
    EXPECT_EQ(renderer.statistics().bricks_produced, 0U);
    EXPECT_EQ(renderer.prefetch(behind_, 0.0), 0U) << "there was no time";
    EXPECT_THROW((void)renderer.prefetch(behind_, -1.0), Error);
}

std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0;
    std::size_t resident = 0;
    statm >> total >> resident;
    return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

/// Names that OpenGL knows.
std::size_t gl_objects() {
    std::size_t count = 0;
    for (GLuint name = 1; name < 4096; ++name) {
        for (const bool lives : {glIsBuffer(name) == GL_TRUE, glIsTexture(name) == GL_TRUE,
                                 glIsProgram(name) == GL_TRUE, glIsShader(name) == GL_TRUE})
            count += lives ? 1 : 0;
    }
    return count;
}

/// Somewhere around the scene or in it, looking at some point of it.
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
    view.width = 16;
    view.height = 12;
    TreeOptions options{.max_resolution = 1024};
    options.brick_pool_bytes = 24 * slot_bytes;
    options.node_pool_bytes = std::size_t(12) * 64 * 16;
    options.brick_cache_bytes = std::size_t(2) << 20U;
    Renderer renderer(scene, snapshot, options);
    Random random(77);
    std::size_t objects = 0;
    std::size_t bytes = 0;
    std::uint64_t evicted = 0;
    for (int frame = 0; frame < frames; ++frame) {
        SCOPED_TRACE(fmt::format("seed 77, frame {}", frame));
        const View next = random_view(view, snapshot.bounds, random);
        if (frame % 5 == 0) {
            (void)renderer.render(next);
        } else {
            (void)renderer.render_within(next, 0.0);
        }
        evicted += renderer.statistics().bricks_evicted;
        ASSERT_LE(renderer.statistics().brick_cache_bytes, options.brick_cache_bytes);
        if (frame != warm_up) continue;
        objects = gl_objects();
        bytes = resident_bytes();
    }
    EXPECT_GT(evicted, 1000U) << "the pools were not exhausted";
    EXPECT_EQ(gl_objects(), objects);
    EXPECT_LE(resident_bytes(), bytes + most_growth);
    const View last = random_view(view, snapshot.bounds, random);
    EXPECT_EQ(renderer.render(last).rgba,
              Renderer(scene, snapshot, {.max_resolution = 1024}).render(last).rgba);
}

TEST_F(CacheStability, SizesMayChangeWithEveryFrame) {
    Renderer renderer = make();
    Renderer fresh = make();
    Random random(5);
    for (int frame = 0; frame < 40; ++frame) {
        View view = view_;
        view.pixel_error = 1.0;
        view.width = int(random.between(1, 150));
        view.height = int(random.between(1, 150));
        const optics::Image ours =
            frame % 3 == 0 ? renderer.render(view) : renderer.render_within(view, frame % 3 == 1 ? 0.0 : 1e9);
        EXPECT_EQ(ours.rgba.size(), std::size_t(view.width) * std::size_t(view.height) * 4);
        if (!renderer.statistics().converged) continue;
        fresh.forget_picture();
        EXPECT_EQ(ours.rgba, fresh.render(view).rgba)
            << "seed 5, frame " << frame << ": " << view.width << " x " << view.height;
    }
}

}  // namespace
}  // namespace cairn::test

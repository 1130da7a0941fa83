#include "renderer/renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/kept_picture.h"
#include "renderer/march/marcher.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/batch_pace.h"
#include "renderer/produce/surface_content.h"
#include "shaders/interop/config.h"
#include "voxelizer/surface.h"

namespace cairn::renderer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}
double milliseconds_since(Clock::time_point start) {
    return milliseconds(Clock::now() - start);
}

Clock::time_point deadline_in(double budget_ms) {
    constexpr double a_day = 86.4e6;
    if (!(budget_ms >= 0.0))
        throw Error(Fault::usage, "frame budget", "it is negative or not a number", "give it milliseconds");
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double, std::milli>(std::min(budget_ms, a_day)));
}

/// A tile query of a frame that must not take long.
struct Question {
    std::uint32_t entry, rays;
    int level;
    bool for_children, to_stand_in;
};

/// Asked for by most rays first, the coarsest first among equals.
std::vector<Question> by_urgency(const PassResult& pass, const Tree& tree) {
    std::vector<Question> questions;
    for (const std::uint32_t query : pass.queries) {
        const bool to_stand_in = query >= 2 * tree.entry_count();
        const std::uint32_t entry = to_stand_in ? query - 2 * tree.entry_count() : query / 2;
        questions.push_back({entry, pass.query_counts[query % QUERY_COUNTS], tree.tile(entry).level,
                             !to_stand_in && query % 2 == QUERY_CHILDREN, to_stand_in});
    }
    std::sort(questions.begin(), questions.end(), [](const Question& a, const Question& b) {
        return std::tuple(b.rays, a.level, a.entry) < std::tuple(a.rays, b.level, b.entry);
    });
    return questions;
}

/// Frames of the same rows of the same view, one after the other.
struct Refined {
    View view;
    Rows rows;
    std::uint32_t since = 0;  ///< round in which they began; what they used is kept
    /// When the pools had filled: tiles that were stood in for. What stood in at first is kept too; while a
    /// new start leaves fewer missing, there is another.
    std::uint32_t stood_in = 0xFFFFFFFFU;
};

/// The same rays at fewer pixels: each sees the levels that it would see in the whole picture.
View thinned(const View& view) {
    View thin = view;
    for (int stride = 4;
         thin.width == view.width || Marcher::band_rows(thin.width, thin.height) < thin.height; stride *= 2) {
        thin.width = (view.width + stride - 1) / stride;
        thin.height = (view.height + stride - 1) / stride;
        if (view.width == 1) break;
    }
    thin.pixel_error = view.pixel_error * thin.height / view.height;
    return thin;
}

voxelizer::Surface flatten(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                           const TreeShape& shape) {
    const voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, shape.resolution());
    return voxelizer::build_surface(scene, snapshot, grid, {.attributes = true});
}

/// A camera that cannot be is a fault of the caller, and NaN in a shader is a picture that nobody can
/// explain.
void check(const View& view) {
    const Camera& camera = view.camera;
    auto fail = [](const std::string& what, const std::string& way_out) {
        throw Error(Fault::usage, "view", what, way_out);
    };
    if (view.width < 1 || view.height < 1 || view.width > 16384 || view.height > 16384) {
        fail(fmt::format("a picture of {} x {} pixels", view.width, view.height),
             "each side is between 1 and 16384");
    }
    if (!(camera.yfov > 0.0 && camera.yfov < 3.14159)) {
        fail("the field of view is not between 0 and 180 degrees", "45 degrees suit most scenes");
    }
    if (!(view.pixel_error > 0.0)) fail("the pixel error is not positive", "1 is the default");
    const glm::dvec3 forward = camera.target - camera.eye;
    const double length = glm::length(forward);
    if (!std::isfinite(length)) fail("the camera or its target is not finite", "use finite coordinates");
    if (length == 0.0) fail("the camera looks at where it stands", "move its target away from it");
    const double side = glm::length(glm::cross(forward / length, camera.up));
    if (!std::isfinite(side) || side < 1e-9) {
        fail("the camera's up direction is the one it looks along", "choose another up direction");
    }
    const glm::dvec3 light = view.light.positional ? view.light.position : view.light.towards;
    if (!std::isfinite(glm::length(light)) || (!view.light.positional && glm::length(light) == 0.0)) {
        fail("the light has no direction", "give it a finite one that is not zero");
    }
}

/// What shade.glsl's write_pixel() writes where there is nothing.
Image background_image(const View& view, Rows rows) {
    std::array<std::uint8_t, 4> pixel{};
    for (int channel = 0; channel < 3; ++channel) {
        const float c = std::clamp(view.background[channel], 0.0F, 1.0F);
        const float encoded = c > 0.0031308F ? 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F : 12.92F * c;
        pixel[std::size_t(channel)] = std::uint8_t(std::lround(255.0F * encoded));
    }
    Image image{view.width, rows.count, {}};
    image.rgba.reserve(std::size_t(view.width) * std::size_t(rows.count) * 4);
    for (std::int64_t i = 0; i < std::int64_t(view.width) * rows.count; ++i)
        image.rgba.insert(image.rgba.end(), pixel.begin(), pixel.end());
    return image;
}

/// The view in voxels of the finest level, from the root cube's low corner.
interop::MarchView march_view(const View& view, const voxelizer::Grid& grid, int n) {
    auto place = [&](const glm::dvec3& world) { return glm::vec3((world - grid.origin) / grid.voxel_size); };
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double half_height = std::tan(0.5 * view.camera.yfov);
    const double half_width = half_height * view.width / view.height;

    // Levels are n apart: the nearest one, as in mip mapping, has voxels between 1 / sqrt(n) and sqrt(n)
    // pixels.
    const double cone = 2.0 * half_height / view.height * view.pixel_error * std::sqrt(double(n));

    // Far from the scene a float's step is many voxels: then rays start near the root cube, from the plane
    // that the eye moved forward lies in.
    const double side = grid.resolution.x;
    const glm::dvec3 eye = (view.camera.eye - grid.origin) / grid.voxel_size;
    const double distance = glm::dot(glm::dvec3(0.5 * side) - eye, forward);
    const double skipped = distance > 3.0 * side ? distance - 2.0 * side : 0.0;

    interop::MarchView out{};
    out.eye = glm::vec4(glm::vec3(eye + forward * skipped), float(cone));
    out.forward = glm::vec4(glm::vec3(forward), float(skipped));
    out.right = glm::vec4(glm::vec3(right * half_width), 0.0F);
    out.up = glm::vec4(glm::vec3(up * half_height), 0.0F);
    out.light = view.light.positional ? glm::vec4(place(view.light.position), 1.0F)
                                      : glm::vec4(glm::vec3(glm::normalize(view.light.towards)), 0.0F);
    out.light_color = glm::vec4(view.light.color, view.light.ambient);
    out.background = glm::vec4(view.background, 0.0F);
    out.size_shadow = glm::ivec4(view.width, view.height, view.shadow == Shadow::hard ? 1 : 0, 0);
    const auto finite = [](const glm::vec4& v) { return std::isfinite(glm::dot(v, glm::vec4(1.0F))); };
    if (!finite(out.eye) || !finite(out.forward) || !finite(out.light)) {
        throw Error(Fault::usage, "view", "the camera or the light is too far away for a float to tell",
                    "bring it nearer to the scene");
    }
    return out;
}

}  // namespace

/// In the order of the data's way: oracle and producer, pools, marcher.
struct Renderer::Parts {
    Parts(const TreeShape& tree_shape, std::unique_ptr<Content> shown, const TreeOptions& options,
          const gl::ShaderSource& shaders)
        : shape(tree_shape),
          content(std::move(shown)),
          pool(shape, content->has_color(), options.brick_pool_bytes),
          tree(shape, pool.slot_count(), options.node_pool_bytes, content->oracle().child_mask(Tile{})),
          marcher(shape, content->has_color(), shaders, options.query_capacity) {
        if (options.brick_cache_bytes == 0) return;
        cache.emplace(pool, options.brick_cache_bytes);
        tree.record_evictions(true);
    }

    void converge(const std::function<void(double)>& progress, double pixels, double pixels_before);
    void serve(std::vector<std::uint32_t> queries);
    void fill(const std::vector<BrickRequest>& requests);
    void refine(Clock::time_point deadline);
    [[nodiscard]] PassResult march(PassKind kind);
    enum class Serve : std::uint8_t { in_any_case, in_time, ahead };
    [[nodiscard]] bool serve_until(Clock::time_point deadline, const PassResult& pass, Serve how);
    void subdivide(std::uint32_t entry);
    void keep_nothing();
    void keep_what_was_used_for(const View& view, Rows rows);
    [[nodiscard]] interop::MarchView marched_view(const View& view) const;
    [[nodiscard]] bool is_empty() const;
    void note_caches(const FrameStatistics& before);
    [[nodiscard]] FrameStatistics totals() const;

    TreeShape shape;
    std::unique_ptr<Content> content;
    BrickPool pool;
    Tree tree;
    Marcher marcher;
    std::optional<BrickCache> cache;
    BatchPace batches;
    KeptPicture picture;
    Refined refined;
    std::uint64_t prefetched = 0;   ///< since the last frame
    std::uint32_t frame_round = 1;  ///< what was used since is the last frame's
    std::uint32_t round = 1;
    FrameStatistics statistics;
};

Renderer::Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options,
                   const gl::ShaderSource& shaders) {
    const TreeShape shape = make_tree_shape(options.n, options.m, options.max_resolution);
    auto content = std::make_unique<SurfaceContent>(shape, flatten(scene, snapshot, shape), shaders);
    parts_ = std::make_unique<Parts>(shape, std::move(content), options, shaders);
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::Parts::subdivide(std::uint32_t entry) {
    if (!tree.wants_children(entry)) return;
    const std::optional<std::uint32_t> first = tree.add_children(entry);
    if (!first) return;
    ++statistics.nodes_subdivided;
    const Tile tile = tree.tile(entry);
    const glm::uvec2 mask = content->oracle().child_mask(tile);
    for (int child = 0; child < shape.child_count(); ++child) {
        if ((mask[child / 32] >> (child % 32) & 1U) == 0) continue;
        tree.set_child_mask(*first + std::uint32_t(child),
                            content->oracle().child_mask(child_of(tile, shape.n, child)));
    }
}

/// Answers the tile queries of a pass. Bricks come first, then the deepest nodes: whatever the pools' sizes,
/// the ray that is nearest to its data gets it, so every pass brings some ray forward and the frame ends.
void Renderer::Parts::serve(std::vector<std::uint32_t> queries) {
    auto level = [&](std::uint32_t query) { return tree.tile(query / 2).level; };
    std::sort(queries.begin(), queries.end(), [&](std::uint32_t a, std::uint32_t b) {
        const bool brick_a = a % 2 == QUERY_BRICK;
        const bool brick_b = b % 2 == QUERY_BRICK;
        if (brick_a != brick_b) return brick_a;
        if (level(a) != level(b)) return level(a) > level(b);
        return a < b;
    });
    std::vector<BrickRequest> requests;
    for (const std::uint32_t query : queries) {
        const std::uint32_t entry = query / 2;
        if (query % 2 == QUERY_CHILDREN) {
            subdivide(entry);
        } else if (tree.wants_brick(entry)) {
            if (const std::optional<int> slot = tree.add_brick(entry))
                requests.push_back({tree.tile(entry), *slot});
        }
    }
    fill(requests);
    statistics.tile_queries += queries.size();
    tree.upload();
}

/// Puts bricks in the slots that they were given: from main memory where they are there, else produced.
void Renderer::Parts::fill(const std::vector<BrickRequest>& requests) {
    std::vector<BrickRequest> unknown;
    if (cache) {
        cache->store(tree.take_evicted());
        std::copy_if(
            requests.begin(), requests.end(), std::back_inserter(unknown),
            [&](const BrickRequest& request) { return !cache->restore(request.tile, request.slot); });
    }
    const std::vector<BrickRequest>& missing = cache ? unknown : requests;
    content->producer().produce(missing, pool);
    statistics.bricks_produced += missing.size();
}

PassResult Renderer::Parts::march(PassKind kind) {
    const auto start = Clock::now();
    PassResult pass = marcher.run_pass(round, tree, pool, kind);
    statistics.march_ms += milliseconds_since(start);
    ++statistics.passes;
    ++round;
    tree.begin_round(round, pass.brick_stamps);
    return pass;
}

/// Answers the most urgent tile queries until time is up, in batches that end soon after it; the first batch
/// in any case, or only while there is time, or (ahead) so that nothing loses its place which the last frame
/// used.
/// @return whether any was answered.
bool Renderer::Parts::serve_until(Clock::time_point deadline, const PassResult& pass, Serve how) {
    const std::vector<Question> questions = by_urgency(pass, tree);
    statistics.tile_queries += questions.size();
    std::uint64_t all_answered = 0;
    std::vector<BrickRequest> requests;
    auto next = questions.begin();
    for (bool first = how == Serve::in_any_case; next != questions.end(); first = false) {
        const auto start = Clock::now();
        if (start > deadline && !first) break;
        const std::size_t batch = batches.batch(milliseconds(deadline - start));
        const std::uint64_t nodes_before = statistics.nodes_subdivided;
        for (;
             next != questions.end() && requests.size() + statistics.nodes_subdivided - nodes_before < batch;
             ++next) {
            if (next->for_children) {
                subdivide(next->entry);
            } else if (tree.wants_brick(next->entry)) {
                const bool may_stay = !next->to_stand_in && how != Serve::ahead;
                if (const std::optional<int> slot = tree.add_brick(next->entry, may_stay))
                    requests.push_back({tree.tile(next->entry), *slot});
            }
        }
        fill(requests);
        glFinish();
        const std::size_t answered = requests.size() + statistics.nodes_subdivided - nodes_before;
        batches.learn(milliseconds_since(start), answered);
        all_answered += answered;
        requests.clear();
    }
    tree.upload();
    return all_answered > 0;
}

/// Passes and production in turn until nothing is missing or time is up; then what is missing is stood in
/// for.
void Renderer::Parts::refine(Clock::time_point deadline) {
    bool any_answered = false;
    auto serve_pass = [&](const PassResult& pass) {
        const auto start = Clock::now();
        const bool answered = serve_until(deadline, pass, any_answered ? Serve::in_time : Serve::in_any_case);
        statistics.produce_ms += milliseconds_since(start);
        any_answered = any_answered || answered;
        return answered;
    };
    for (;;) {
        const PassResult pass = march(PassKind::progressive);
        const bool answered = serve_pass(pass);
        if (pass.done()) return;
        if (Clock::now() > deadline || (!answered && !pass.queries.empty())) break;
    }
    std::uint32_t stood_in = 0;
    for (bool done = false; !done;) {
        const PassResult pass = march(PassKind::stand_in);
        stood_in += pass.stood_in;
        statistics.converged = statistics.converged && pass.stood_in == 0;
        // What only these rays have asked for, as shadow rays may, brings the next frame forward.
        (void)serve_pass(pass);
        done = pass.done();
    }
    if (any_answered || stood_in >= refined.stood_in) return;
    refined.since = 0;
    refined.stood_in = stood_in;
}

/// A frame that has all the time may give up what a pass has used: no ray goes back.
void Renderer::Parts::keep_nothing() {
    frame_round = round;
    tree.keep_since(0);
}

/// What frames of these rows use is kept from the first of them on, so that they come to an end.
void Renderer::Parts::keep_what_was_used_for(const View& view, Rows rows) {
    if (!(view == refined.view && rows == refined.rows)) refined = {view, rows};
    if (refined.since == 0) refined.since = round;
    frame_round = refined.since;
    tree.keep_since(frame_round);
}

/// Nothing in the whole scene: known without a ray. (A tree of one level has no children to tell it.)
bool Renderer::Parts::is_empty() const {
    return shape.max_level > 0 && tree.node(0).child_mask == glm::uvec2(0);
}

interop::MarchView Renderer::Parts::marched_view(const View& view) const {
    interop::MarchView marched = march_view(view, content->grid(), shape.n);
    marched.surface_color = glm::vec4(content->uniform_color(), 1.0F);
    return marched;
}

/// Counters since the renderer was made.
FrameStatistics Renderer::Parts::totals() const {
    FrameStatistics total;
    total.bricks_evicted = tree.counters().bricks_evicted;
    total.nodes_evicted = tree.counters().nodes_evicted;
    total.bricks_relinked = tree.counters().bricks_relinked;
    total.bricks_cached = cache ? cache->counters().stored : 0;
    total.bricks_restored = cache ? cache->counters().restored : 0;
    return total;
}

void Renderer::Parts::note_caches(const FrameStatistics& before) {
    const FrameStatistics now = totals();
    statistics.bricks_evicted = now.bricks_evicted - before.bricks_evicted;
    statistics.nodes_evicted = now.nodes_evicted - before.nodes_evicted;
    statistics.bricks_relinked = now.bricks_relinked - before.bricks_relinked;
    statistics.bricks_cached = now.bricks_cached - before.bricks_cached;
    statistics.bricks_restored = now.bricks_restored - before.bricks_restored;
    statistics.bricks_prefetched = std::exchange(prefetched, 0);
    statistics.bricks_resident = std::uint64_t(tree.bricks_resident());
    statistics.brick_slots = std::uint64_t(pool.slot_count());
    statistics.node_pool_bytes = tree.size_bytes();
    statistics.brick_pool_bytes = pool.size_bytes();
    statistics.brick_cache_bytes = cache ? cache->size_bytes() : 0;
}

/// Passes of rays and what they ask for, in turn, until nothing is missing.
void Renderer::Parts::converge(const std::function<void(double)>& progress, double pixels,
                               double pixels_before) {
    for (;;) {
        const PassResult pass = march(PassKind::patient);
        if (pass.done()) return;
        const auto start = Clock::now();
        serve(pass.queries);
        statistics.produce_ms += milliseconds_since(start);
        const double waiting = pass.waiting_primary + 0.5 * pass.waiting_shadow;
        const double band = double(marcher.band_pixels());
        if (progress) progress((pixels_before + band - waiting) / pixels);
    }
}

Image Renderer::march(const View& view, Rows rows, const std::function<void(int)>& march_band) {
    check(view);
    if (rows.first < 0 || rows.count < 1 || rows.count > view.height - rows.first) {
        throw Error(
            Fault::usage, "view",
            fmt::format("{} rows from row {} of a picture of {}", rows.count, rows.first, view.height),
            "ask for rows that the picture has");
    }
    Parts& parts = *parts_;
    const auto start = Clock::now();
    const FrameStatistics before = parts.totals();
    parts.statistics = FrameStatistics{};
    FrameStatistics& statistics = parts.statistics;

    interop::MarchView marched = parts.marched_view(view);
    const int band_rows = Marcher::band_rows(view.width, view.height);
    Image image = parts.is_empty() ? background_image(view, rows) : parts.picture.rows(view, rows);
    const bool is_known = !image.rgba.empty();
    if (!is_known) image = {view.width, rows.count, {}};
    const int end = rows.first + rows.count;
    for (int row = rows.first; row < end && !is_known; row += band_rows) {
        marched.band = glm::ivec4(row, std::min(band_rows, end - row), int(view.show), 0);
        parts.marcher.begin_frame(marched, parts.tree, parts.pool);
        march_band(row);
        std::vector<std::uint8_t> band = parts.marcher.read_image();
        if (image.rgba.empty()) {
            image.rgba = std::move(band);
        } else {
            image.rgba.insert(image.rgba.end(), band.begin(), band.end());
        }
    }

    if (!is_known && statistics.converged) parts.picture.keep(view, rows, image);
    parts.note_caches(before);
    statistics.milliseconds = milliseconds_since(start);
    return image;
}

Image Renderer::render(const View& view, const std::function<void(double)>& progress) {
    parts_->keep_nothing();
    return march(view, {0, view.height}, [&](int row) {
        parts_->converge(progress, double(view.width) * view.height, double(view.width) * row);
    });
}

Image Renderer::render_rows(const View& view, Rows rows) {
    parts_->keep_nothing();
    return march(view, rows, [&](int) { parts_->converge({}, 0.0, 0.0); });
}

Image Renderer::render_within(const View& view, double budget_ms) {
    return render_rows_within(view, {0, view.height}, budget_ms);
}

Image Renderer::render_rows_within(const View& view, Rows rows, double budget_ms) {
    const auto deadline = deadline_in(budget_ms);
    parts_->keep_what_was_used_for(view, rows);
    return march(view, rows, [&](int) { parts_->refine(deadline); });
}

std::uint64_t Renderer::prefetch(const View& next, double budget_ms) {
    check(next);
    const auto deadline = deadline_in(budget_ms);
    Parts& parts = *parts_;
    if (parts.is_empty()) return 0;
    const FrameStatistics of_frame = parts.statistics;
    const View thin = thinned(next);
    interop::MarchView marched = parts.marched_view(thin);
    marched.band = glm::ivec4(0, thin.height, int(thin.show), 0);
    parts.tree.keep_since(parts.frame_round);
    parts.marcher.begin_frame(marched, parts.tree, parts.pool);
    while (Clock::now() < deadline) {
        const PassResult pass = parts.march(PassKind::progressive);
        if (!parts.serve_until(deadline, pass, Parts::Serve::ahead) || pass.done()) break;
    }
    const std::uint64_t produced = parts.statistics.bricks_produced - of_frame.bricks_produced;
    parts.prefetched += produced;
    parts.statistics = of_frame;
    return produced;
}

void Renderer::forget_picture() {
    parts_->picture.forget();
}

const FrameStatistics& Renderer::statistics() const {
    return parts_->statistics;
}

}  // namespace cairn::renderer

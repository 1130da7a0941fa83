#include "renderer/frame/frame_loop.h"

#include <algorithm>
#include <bit>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/frame/prefetch_view.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {
namespace {

/// Parts in a row that use at most a quarter of the bricks in the pool, before parts become larger.
constexpr int most_small_parts = 32;

ContentProgram program_of(const Content& content) {
    ContentProgram program = content.program();
    program.has_constant = content.has_constant();
    program.has_final = content.has_low_frequency();
    return program;
}

}  // namespace

FrameLoop::FrameLoop(std::unique_ptr<Content> content, const PoolSizes& pools, const MarchOptions& options,
                     const gl::ShaderSource& shaders)
    : cache_(std::move(content), pools),
      marcher_(cache_.shape(), cache_.content().channels(), options, shaders, program_of(cache_.content())),
      tile_queries_(options.tile_queries) {
    if (cache_.shape().mips != 0 && !cache_.content().fills_mips()) {
        throw Error(Fault::usage, "tree", "the bricks of this content have no mip levels",
                    "leave the mips and blended levels of detail to surfaces");
    }
}

void FrameLoop::set_mix(const Mix& mix) {
    mix_ = mix;
    picture_.forget();
}

void FrameLoop::check_request(const View& view, Rows rows) const {
    check_view(view, cache_.shape());
    if (rows.first < 0 || rows.count < 1 || rows.count > view.size.height - rows.first) {
        throw Error(
            Fault::usage, "view",
            fmt::format("{} rows from row {} of a picture of {}", rows.count, rows.first, view.size.height),
            "ask for rows that the picture has");
    }
    if (view.shadow.kind == ShadowQuality::Kind::cones && !shows_surface())
        throw Error(Fault::usage, "view", "shadow cones through a volume", "send it shadow rays");
}

/// For frames that keep bricks from frame to frame: they need reports of all bricks that a pass used.
void FrameLoop::require_lists() const {
    if (tile_queries_ == TileQueries::list) return;
    throw Error(Fault::usage, "tile queries", "blocks of pixels do not report all that a frame used",
                "choose lists for frames within a budget and for prefetching");
}

optics::Image FrameLoop::render(const View& view, Rows rows, int shown,
                                const std::function<void(double)>& progress) {
    check_request(view, rows);
    frame_since_ = round_;
    double most_done = 0.0;
    return render_bands(view, rows, shown, [&](int row) {
        if (!progress) return Goal::nothing_missing();
        return Goal::nothing_missing([&, row](double done) {
            // A part that is given up begins again.
            const double before = double(view.size.width) * (row - rows.first);
            most_done = std::max(most_done, before + done);
            progress(most_done / (double(view.size.width) * rows.count));
        });
    });
}

optics::Image FrameLoop::render_until(const View& view, Rows rows, int shown, Clock::time_point deadline) {
    require_lists();
    check_request(view, rows);
    // The pools keep what frames of these rows use from the first of them on, so that they come to an end.
    if (!(view == refinement_.view && rows == refinement_.rows)) refinement_ = {view, rows, {}, {}};
    if (!refinement_.since) refinement_.since = round_;
    frame_since_ = *refinement_.since;
    cache_.keep_since(frame_since_);
    return render_bands(view, rows, shown, [&](int) { return Goal::until(deadline); });
}

optics::Image FrameLoop::render_bands(const View& view, Rows rows, int shown,
                                      const std::function<Goal(int)>& goal_of) {
    const auto start = Clock::now();
    const TileCache::Counters cache_before = cache_.counters();
    const PassCounters passes_before = passes_;
    statistics_ = FrameStatistics{};
    Band band = make_band(view, cache_.content(), cache_.shape());
    if (!prefetch_state_ || !(view == prefetch_state_->view)) prefetch_state_ = PrefetchState{view, round_};

    const bool shows_light = shown == SHOW_LIGHT;
    optics::Image image;
    if (!shows_light) {
        image = cache_.is_empty() && mix_.meshes == nullptr ? background_image(view, rows)
                                                            : picture_.rows(view, rows);
    }
    if (image.rgba.empty()) {
        const std::uint32_t background = shows_light ? std::bit_cast<std::uint32_t>(float(SHOWN_NOTHING))
                                                     : background_pixel(view.background);
        image = {view.size.width, rows.count, {}};
        run_bands(band, rows, shown, background, goal_of, image);
        if (!shows_light && statistics_.converged) picture_.keep(view, rows, image);
    }
    note_frame(cache_before, passes_before);
    statistics_.milliseconds = milliseconds_since(start);
    return image;
}

void FrameLoop::run_bands(Band& band, Rows rows, int shown, std::uint32_t background,
                          const std::function<Goal(int)>& goal_of, optics::Image& image) {
    const int band_rows = Marcher::band_rows(band.view.width, band.view.height);
    const int end = rows.first + rows.count;
    int row = rows.first;
    while (row < end) {
        const int drawn_end = std::min(draw_mix(band, mix_, cache_.content().grid(), row), end);
        const int count = std::min(band_rows, drawn_end - row);
        set_rows(band, {row, count}, shown, background);
        const Outcome outcome = run_band(band, goal_of(row));
        if (outcome.stood_in) start_again_for_less(outcome);
        statistics_.converged = statistics_.converged && outcome.stood_in.value_or(0) == 0;
        std::vector<std::uint8_t> pixels = marcher_.read_image();
        if (image.rgba.empty()) {
            image.rgba = std::move(pixels);
        } else {
            image.rgba.insert(image.rgba.end(), pixels.begin(), pixels.end());
        }
        row += count;
    }
}

Outcome FrameLoop::run_band(Band& band, const Goal& goal) {
    marcher_.begin_frame(band.view, cache_.tree(), cache_.pool(), band.is_blended, band.mix);
    if (goal.end != Goal::End::nothing_missing) return run_part(band, goal);
    run_parts(band, goal);
    Outcome outcome;
    outcome.done = true;
    return outcome;
}

/// Runs a band without a budget: all of it at once, or, if what it uses passes the pools, in parts that use
/// less, so that few bricks are produced again that had to go too early. If the pools do not hold what a
/// single block uses, parts are of no use: then the rest is run at once, and what it used may go, because no
/// ray goes back.
void FrameLoop::run_parts(Band& band, const Goal& goal) {
    const std::size_t blocks = marcher_.block_count();
    bool may_give_up = true;
    bool is_whole = true;  // begin_frame() has chosen all blocks
    for (std::size_t first = 0; first < blocks;) {
        const std::size_t rest = blocks - first;
        const std::size_t count = may_give_up ? std::min(part_blocks_, rest) : rest;
        if (!is_whole || count < blocks) marcher_.begin_part(first, count);
        is_whole = count == blocks;
        const Round since = round_;
        if (run_part(band, goal, may_give_up).gave_up) {
            may_give_up = count > 1;
            small_parts_ = 0;
            part_blocks_ = (count + 1) / 2;
            continue;
        }
        const bool used_little =
            4 * cache_.tree().bricks_used_since(since) <= cache_.tree().bricks_resident();
        small_parts_ = used_little ? small_parts_ + 1 : 0;
        if (small_parts_ == most_small_parts && part_blocks_ < blocks) {
            part_blocks_ *= 2;
            small_parts_ = 0;
        }
        first += count;
    }
}

/// @param may_give_up  for patient goals: the part ends when something that it used would have to go for
/// something
///                     else that it needs. If false, that goes: no ray goes back, so the part comes to its
///                     end.
Outcome FrameLoop::run_part(Band& band, const Goal& goal, bool may_give_up) {
    const bool is_patient = goal.end == Goal::End::nothing_missing;
    if (is_patient) cache_.keep_since(may_give_up ? std::optional(round_) : std::nullopt);
    PassKind kind = is_patient ? PassKind::patient : PassKind::progressive;
    Outcome outcome;
    for (;;) {
        const PassResult pass = run_pass(band, kind);
        if (kind == PassKind::stand_in) outcome.stood_in = outcome.stood_in.value_or(0) + pass.stood_in;
        outcome.done = pass.done();
        if (is_patient && outcome.done) return outcome;
        // Some queries come only from the rays of stand-in passes, for example of shadow rays. Their answers
        // bring the next frame forward.
        const TileCache::Answer answer = produce(band, pass, goal, outcome.answered);
        const bool answered = answer.count() > 0;
        // A brick may be refused its room when it has been produced.
        const bool is_refused = answer.refused != 0 || (!answered && !pass.queries.empty());
        outcome.gave_up = may_give_up && is_refused;
        if (outcome.gave_up) return outcome;
        outcome.answered = outcome.answered || answered;
        outcome.no_room = !answered && !pass.queries.empty();
        if (outcome.done) return outcome;
        if (goal.progress) {
            const double waiting =
                pass.waiting_primary + 0.5 * pass.waiting_shadow + marcher_.pixels_behind_part();
            goal.progress(double(marcher_.band_pixels()) - waiting);
        }
        if (kind != PassKind::progressive) continue;
        // Rays that only paused ask for nothing. Prefetching waits for them, because nothing else brings it
        // forward.
        const bool has_paused = goal.end == Goal::End::prefetch && pass.queries.empty();
        if (has_paused || (!outcome.no_room && Clock::now() <= goal.deadline)) continue;
        if (goal.end == Goal::End::prefetch) return outcome;
        kind = PassKind::stand_in;
    }
}

PassResult FrameLoop::run_pass(Band& band, PassKind kind) {
    const auto start = Clock::now();
    if (!band.windows.empty()) {
        find_tiles(band.windows, cache_.tree(), band.ray_windows);
        marcher_.set_windows(band.ray_windows);
    }
    PassResult pass = marcher_.run_pass(round_, cache_.tree(), cache_.pool(), kind);
    passes_.march_ms += milliseconds_since(start);
    ++passes_.passes;
    passes_.rays_launched += pass.launched;
    passes_.query_bytes += pass.bytes_read;
    round_ = round_.next();
    cache_.begin_round(round_, pass.brick_stamps);
    return pass;
}

/// Answers the queries of a pass within the goal.
/// @param any_answered  an earlier pass of the band has had answers. If none has, the first batch is answered
///                      in any case.
TileCache::Answer FrameLoop::produce(Band& band, const PassResult& pass, const Goal& goal,
                                     bool any_answered) {
    const auto start = Clock::now();
    const bool is_prefetch = goal.end == Goal::End::prefetch;
    TileCache::Answer answer =
        goal.end == Goal::End::nothing_missing
            ? cache_.answer(pass.queries)
            : cache_.answer_until(pass.queries, {.deadline = goal.deadline,
                                                 .first_batch_in_any_case = is_prefetch || !any_answered,
                                                 .is_prefetch = is_prefetch});
    const auto before_windows = Clock::now();
    find_tiles_below(band, answer.parents);
    passes_.window_ms += milliseconds_since(before_windows);
    cache_.upload();
    passes_.produce_ms += milliseconds_since(start);
    return answer;
}

/// Rays that miss a tile of a window ask for children of its nearest ancestor. Subdivides down to the tile
/// itself, so that a deep view does not take one pass per level.
/// @param parents  entries that got children because rays asked.
void FrameLoop::find_tiles_below(Band& band, const std::vector<std::uint32_t>& parents) {
    if (band.windows.empty() || parents.empty()) return;
    const Tree& tree = cache_.tree();
    std::unordered_set<std::uint32_t> asked;
    auto add_children_of = [&](std::uint32_t entry) {
        const std::uint32_t first = tree.node(entry).children;
        for (int child = 0; first != 0 && child < cache_.shape().child_count(); ++child)
            asked.insert(first + std::uint32_t(child));
    };
    for (const std::uint32_t entry : parents)
        add_children_of(entry);
    find_tiles(band.windows, tree, band.ray_windows, [&](std::uint32_t entry) {
        if (asked.contains(entry) && cache_.subdivide(entry)) add_children_of(entry);
    });
}

/// When frames of the same view answer no more queries, a new start may do better, without the bricks that
/// stood in at first.
void FrameLoop::start_again_for_less(const Outcome& outcome) {
    if (outcome.answered || (refinement_.stood_in && *outcome.stood_in >= *refinement_.stood_in)) return;
    refinement_.since.reset();
    refinement_.stood_in = outcome.stood_in;
}

std::uint64_t FrameLoop::prefetch(const View& next, Clock::time_point deadline) {
    require_lists();
    check_view(next, cache_.shape());
    const View thin = thinned(next);
    Band band = make_band(thin, cache_.content(), cache_.shape());
    if (cache_.is_empty() || Clock::now() >= deadline) return 0;
    const std::uint64_t before = cache_.counters().bricks_produced;
    set_rows(band, {0, thin.size.height}, int(thin.show), background_pixel(thin.background));
    cache_.keep_since(frame_since_);
    (void)run_band(band, Goal::prefetch_until(deadline));
    const std::uint64_t produced = cache_.counters().bricks_produced - before;
    prefetched_ += produced;
    return produced;
}

PrefetchResult FrameLoop::prefetch_finer(Clock::time_point deadline) {
    require_lists();
    if (cache_.is_empty() || !prefetch_state_) return {};
    const std::uint64_t before = cache_.counters().bricks_produced;
    const View fine = finer(prefetch_state_->view, cache_.shape());
    std::optional<Band> band;
    Rows rows;
    while (!prefetch_state_->is_done && Clock::now() < deadline) {
        if (!band_from_middle(fine, prefetch_state_->bands_done, rows)) {
            prefetch_state_->is_done = true;
            break;
        }
        if (!band) band = make_band(fine, cache_.content(), cache_.shape());
        set_rows(*band, rows, int(fine.show), background_pixel(fine.background));
        cache_.keep_since(prefetch_state_->since);
        const Outcome outcome = run_band(*band, Goal::prefetch_until(deadline));
        if (outcome.done) ++prefetch_state_->bands_done;
        prefetch_state_->is_done = !outcome.done && outcome.no_room;
    }
    const std::uint64_t produced = cache_.counters().bricks_produced - before;
    prefetched_ += produced;
    return {produced, !prefetch_state_->is_done};
}

void FrameLoop::note_frame(const TileCache::Counters& cache_before, const PassCounters& passes_before) {
    const TileCache::Counters cache = cache_.counters() - cache_before;
    FrameStatistics& out = statistics_;
    out.rays_launched = passes_.rays_launched - passes_before.rays_launched;
    out.passes = passes_.passes - passes_before.passes;
    out.query_bytes = passes_.query_bytes - passes_before.query_bytes;
    out.march_ms = passes_.march_ms - passes_before.march_ms;
    out.produce_ms = passes_.produce_ms - passes_before.produce_ms;
    out.tree_ms = cache.tree_ms + passes_.window_ms - passes_before.window_ms;
    out.upload_ms = cache.upload_ms;
    out.tile_queries = cache.tile_queries;
    out.nodes_subdivided = cache.nodes_subdivided;
    out.bricks_produced = cache.bricks_produced;
    out.constant_tiles = cache.constant_tiles;
    out.bricks_evicted = cache.bricks_evicted;
    out.nodes_evicted = cache.nodes_evicted;
    out.bricks_relinked = cache.bricks_relinked;
    out.bricks_cached = cache.bricks_cached;
    out.bricks_restored = cache.bricks_restored;
    out.bricks_prefetched = std::exchange(prefetched_, 0);
    out.bricks_resident = std::uint64_t(cache_.tree().bricks_resident());
    out.bricks_used = std::uint64_t(cache_.tree().bricks_used_since(frame_since_));
    out.brick_slots = std::uint64_t(cache_.pool().slot_count());
    out.node_pool_bytes = cache_.tree().size_bytes();
    out.brick_pool_bytes = cache_.pool().size_bytes();
    out.brick_bytes_resident = cache_.pool().used_bytes(cache_.tree().bricks_resident());
    out.brick_cache_bytes = cache_.brick_cache_bytes();
}

}  // namespace cairn::renderer

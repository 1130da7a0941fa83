#include "renderer/renderer_parts.h"

#include <algorithm>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "renderer/frame/prefetch_view.h"
#include "renderer/march/march_view.h"
#include "renderer/mesh/mesh_raster.h"
#include "shaders/interop/mesh.h"
#include "shaders/interop/tile_query.h"

namespace cairn::renderer {
namespace {

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

MarchKind with_content(MarchKind kind, const Content& content) {
    kind.has_constant = content.has_constant();
    kind.has_final = content.has_low_frequency();
    return kind;
}

}  // namespace

Renderer::Parts::Parts(const TreeShape& tree_shape, std::unique_ptr<Content> shown,
                       const TreeOptions& options, const gl::ShaderSource& shaders, MarchKind kind)
    : shape(tree_shape),
      content(std::move(shown)),
      pool(shape, content->channels(), options.brick_pool_bytes),
      tree(shape, pool.slot_count(), options.node_pool_bytes, content->oracle().child_mask(Tile{}),
           content->has_constant()),
      marcher(shape, content->has_color(),
              {options.traversal, options.block_starts, options.query_capacity, options.tile_queries},
              shaders, with_content(std::move(kind), *content)),
      tile_queries(options.tile_queries) {
    if (options.mips && !content->fills_mips()) {
        throw Error(Fault::usage, "tree", "the bricks of this content have no mip levels",
                    "leave the mips and blended levels of detail to surfaces");
    }
    if (options.brick_cache_bytes == 0) return;
    if (content->has_low_frequency()) {
        throw Error(Fault::usage, "brick cache", "it cannot tell which tiles of this content are final",
                    "leave it out");
    }
    cache.emplace(pool, options.brick_cache_bytes);
    tree.record_evictions(true);
}

/// Draws what the rays of a row meet beside voxels. Returns the row behind the last that has been drawn.
int Renderer::Parts::draw_mix(const interop::MarchView& view, int row) {
    const MarchSpace space{content->grid().origin, content->grid().voxel_size};
    int end = view.height;
    drawn = MarchMix{};
    if (mix.meshes != nullptr) {
        const MeshSurface mesh = mix.meshes->draw_surface(view, space, row);
        drawn.mesh_nearest = mesh.nearest;
        drawn.mesh_surface = mesh.surface;
        drawn.mesh_first_row = mesh.first_row;
        drawn.mesh_shadows = mix.mesh_shadows;
        drawn.voxels_hidden = mix.voxels_hidden;
        drawn.mesh_own_height = mix.meshes_are_voxelized ? MESH_OWN_HEIGHT : 0.0F;
        end = std::min(end, mesh.first_row + mesh.rows);
    }
    if (mix.proxy != nullptr) {
        const MeshSpan span = mix.proxy->draw_span(view, space, row);
        drawn.proxy_span = span.span;
        drawn.proxy_faces = span.faces;
        drawn.proxy_first_row = span.first_row;
        end = std::min(end, span.first_row + span.rows);
    }
    return end;
}

void Renderer::Parts::subdivide(std::uint32_t entry) {
    if (tree.wants_children(entry)) give_children(entry);
}

void Renderer::Parts::give_children(std::uint32_t entry) {
    const std::optional<std::uint32_t> first = tree.add_children(entry);
    if (!first) return;
    ++statistics.nodes_subdivided;
    const Tile tile = tree.tile(entry);
    const glm::uvec2 mask = content->oracle().child_mask(tile);
    for (int child = 0; child < shape.child_count(); ++child) {
        if (!may_hold(mask, shape.n, child)) continue;
        const Tile child_tile = child_of(tile, shape.n, child);
        const std::uint32_t child_entry = *first + std::uint32_t(child);
        if (shape.n == 8 && content->oracle().is_empty(child_tile)) {
            tree.set_constant(child_entry, glm::u8vec4(0));
            tree.set_final(child_entry);
        } else {
            tree.set_child_mask(child_entry, content->oracle().child_mask(child_tile));
        }
    }
}

/// Places the windows too, where there are any.
interop::MarchView Renderer::Parts::march_view_of(const View& view) {
    const voxelizer::Grid& grid = content->grid();
    const Place eye = place_of(view, view.camera.eye, grid);
    if (shape.has_windows()) {
        windows = windows_around(shape, eye);
        drop_empty(windows, shape, content->oracle());
    }
    interop::MarchView marched = march_view(view, grid, shape, windows.empty() ? nullptr : &windows.back());
    marched.surface_color = content->uniform_color();
    if (windows.empty()) return marched;
    const Place light = place_of(view, view.light.position, grid);
    marched_windows =
        march_windows(windows, shape, eye, view.light.positional ? &light : nullptr, view.light.towards);
    marched_windows.back().eye = marched.eye;  // nearer to the scene, where the eye is far from it
    return marched;
}

/// Rays that miss a tile of a window ask for children of its nearest ancestor: brings the tile itself, so
/// that a deep view does not take a pass for each level.
void Renderer::Parts::find_tiles_asked_for(const std::vector<std::uint32_t>& entries) {
    if (!shape.has_windows() || entries.empty()) return;
    std::unordered_set<std::uint32_t> asked;
    auto add_children_of = [&](std::uint32_t entry) {
        const std::uint32_t first = tree.node(entry).children;
        for (int child = 0; first != 0 && child < shape.child_count(); ++child)
            asked.insert(first + std::uint32_t(child));
    };
    for (const std::uint32_t entry : entries)
        add_children_of(entry);
    find_tiles(windows, tree, marched_windows, [&](std::uint32_t entry) {
        if (!asked.contains(entry)) return;
        give_children(entry);
        add_children_of(entry);
    });
}

/// Gives the tile a slot, if there is one, to be filled by produce_requests().
void Renderer::Parts::request(std::uint32_t entry, bool may_stay) {
    if (!tree.wants_brick(entry)) return;
    const std::optional<int> slot = tree.add_brick(entry, may_stay);
    if (!slot) return;
    requests.push_back({tree.tile(entry), *slot});
    requested_entries.push_back(entry);
}

/// Answers from main memory what is there.
void Renderer::Parts::restore_requests() {
    cache->store(tree.take_evicted());
    const auto start = Clock::now();
    std::vector<BrickRequest> unknown;
    std::vector<std::uint32_t> unknown_entries;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (cache->restore(requests[i].tile, requests[i].slot)) continue;
        unknown.push_back(requests[i]);
        unknown_entries.push_back(requested_entries[i]);
    }
    requests = std::move(unknown);
    requested_entries = std::move(unknown_entries);
    statistics.upload_ms += milliseconds_since(start);
}

void Renderer::Parts::upload_nodes() {
    const auto start = Clock::now();
    tree.upload();
    statistics.upload_ms += milliseconds_since(start);
}

/// Puts bricks in the slots that they were given: from main memory where they are there, else produced.
void Renderer::Parts::produce_requests() {
    if (cache) restore_requests();
    const std::vector<Produced> found = content->producer().produce(requests, pool);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::uint32_t entry = requested_entries[i];
        if (content->has_low_frequency()) tree.set_produced(entry);
        if (found[i].low_frequency) tree.set_final(entry);
        if (!found[i].constant) continue;
        tree.set_constant(entry, found[i].mean);
        ++statistics.constant_tiles;
    }
    statistics.bricks_produced += requests.size();
    statistics.upload_ms += content->producer().upload_ms();
    requests.clear();
    requested_entries.clear();
}

/// Answers the tile queries of a pass. Bricks come first, then the deepest nodes: whatever the pools' sizes,
/// the ray that is nearest to its data gets it, so every pass brings some ray forward and the frame ends.
void Renderer::Parts::serve(std::vector<std::uint32_t> queries) {
    const auto start = Clock::now();
    auto level = [&](std::uint32_t query) { return tree.tile(query / 2).level; };
    std::sort(queries.begin(), queries.end(), [&](std::uint32_t a, std::uint32_t b) {
        const bool brick_a = a % 2 == QUERY_BRICK;
        const bool brick_b = b % 2 == QUERY_BRICK;
        if (brick_a != brick_b) return brick_a;
        if (level(a) != level(b)) return level(a) > level(b);
        return a < b;
    });
    std::vector<std::uint32_t> parents;
    for (const std::uint32_t query : queries) {
        const std::uint32_t entry = query / 2;
        if (query % 2 == QUERY_CHILDREN && !wants_brick_first(entry)) {
            subdivide(entry);
            parents.push_back(entry);
        } else {
            request(entry, true);
        }
    }
    find_tiles_asked_for(parents);
    const auto before_bricks = Clock::now();
    produce_requests();
    const auto after_bricks = Clock::now();
    statistics.tile_queries += queries.size();
    statistics.tree_ms += milliseconds_since(start) - milliseconds(after_bricks - before_bricks);
    upload_nodes();
}

PassResult Renderer::Parts::march(PassKind kind) {
    const auto start = Clock::now();
    if (shape.has_windows()) {
        find_tiles(windows, tree, marched_windows);
        marcher.set_windows(marched_windows);
    }
    PassResult pass = marcher.run_pass(round, tree, pool, kind);
    statistics.march_ms += milliseconds_since(start);
    ++statistics.passes;
    statistics.rays_launched += pass.launched;
    statistics.query_bytes += pass.bytes_read;
    ++round;
    tree.begin_round(round, pass.brick_stamps);
    return pass;
}

/// Answers the most urgent tile queries until time is up, in batches that end soon after it.
/// @return whether any was answered.
bool Renderer::Parts::serve_until(Clock::time_point deadline, const PassResult& pass, Serve how) {
    const std::vector<Question> questions = by_urgency(pass, tree);
    statistics.tile_queries += questions.size();
    std::uint64_t all_answered = 0;
    std::vector<std::uint32_t> parents;
    auto next = questions.begin();
    for (bool first = how.in_any_case; next != questions.end(); first = false) {
        const auto start = Clock::now();
        if (start > deadline && !first) break;
        const std::size_t batch = batches.batch(milliseconds(deadline - start));
        const std::uint64_t nodes_before = statistics.nodes_subdivided;
        for (;
             next != questions.end() && requests.size() + statistics.nodes_subdivided - nodes_before < batch;
             ++next) {
            if (next->for_children && !wants_brick_first(next->entry)) {
                subdivide(next->entry);
                parents.push_back(next->entry);
            } else {
                request(next->entry, !next->to_stand_in && !how.ahead);
            }
        }
        find_tiles_asked_for(parents);
        parents.clear();
        const std::size_t answered = requests.size() + statistics.nodes_subdivided - nodes_before;
        produce_requests();
        glFinish();
        batches.learn(milliseconds_since(start), answered);
        all_answered += answered;
    }
    upload_nodes();
    return all_answered > 0;
}

/// Passes and production in turn until nothing is missing or time is up; then what is missing is stood in
/// for.
void Renderer::Parts::refine(Clock::time_point deadline) {
    bool any_answered = false;
    auto serve_pass = [&](const PassResult& pass) {
        const auto start = Clock::now();
        const bool answered = serve_until(deadline, pass, {.in_any_case = !any_answered});
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

/// What stays from frame to frame, and what makes room, must be known in full.
void Renderer::Parts::require_lists() const {
    if (tile_queries == TileQueries::list) return;
    throw Error(Fault::usage, "tile queries", "blocks of pixels do not tell all that a frame used",
                "choose lists for frames within a budget and for prefetching");
}

/// Produces for the next band of the last view one level finer, until it is done or time is up. The first
/// answers come in any case, so that each call gets on.
void Renderer::Parts::look_ahead(Clock::time_point deadline) {
    const View fine = finer(ahead.view, shape);
    Rows rows;
    if (!band_from_middle(fine, ahead.bands_done, rows)) {
        ahead.done = true;
        return;
    }
    interop::MarchView marched = march_view_of(fine);
    marched.first_row = rows.first;
    marched.row_count = rows.count;
    tree.keep_since(ahead.since);
    marcher.begin_frame(marched, tree, pool, blends(ahead.view));
    for (;;) {
        const PassResult pass = march(PassKind::progressive);
        const bool answered = serve_until(deadline, pass, {.in_any_case = true, .ahead = true});
        if (pass.done()) {
            ++ahead.bands_done;
            return;
        }
        if (pass.queries.empty()) continue;  // rays paused
        ahead.done = !answered;              // there is no more room
        if (ahead.done || Clock::now() > deadline) return;
    }
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

/// @throws Error (Fault::usage) when the view asks for blended levels of detail and bricks have no mips.
bool Renderer::Parts::blends(const View& view) const {
    const bool is_blended = view.level_of_detail == LevelOfDetail::blended;
    if (is_blended && shape.mips == 0) {
        throw Error(Fault::usage, "view", "levels of detail cannot be blended without mip levels",
                    "make the renderer of a surface with TreeOptions::mips");
    }
    return is_blended;
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
    statistics.bricks_used = std::uint64_t(tree.bricks_used_since(frame_round));
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

}  // namespace cairn::renderer

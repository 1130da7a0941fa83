#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "renderer/frame/kept_picture.h"
#include "renderer/march/marcher.h"
#include "renderer/march/windows.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/batch_pace.h"
#include "renderer/produce/content.h"
#include "renderer/renderer.h"
#include "shaders/interop/march.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// Frames of the same rows of the same view, one after the other.
struct Refined {
    View view;
    Rows rows;
    std::uint32_t since = 0;  ///< round in which they began; what they used is kept
    /// When the pools had filled: tiles that were stood in for. What stood in at first is kept too; while a
    /// new start leaves fewer missing, there is another.
    std::uint32_t stood_in = 0xFFFFFFFFU;
};

/// The last view, of which prefetch_finer() produces more than it shows.
struct Ahead {
    View view;
    std::uint32_t since = 1;  ///< round in which it was first rendered
    int bands_done = 0;
    bool done = true;
};
/// In the order of the data's way: oracle and producer, pools, marcher.
struct Renderer::Parts {
    Parts(const TreeShape& tree_shape, std::unique_ptr<Content> shown, const TreeOptions& options,
          const gl::ShaderSource& shaders, MarchKind kind = {});

    [[nodiscard]] interop::MarchView march_view_of(const View& view);
    void find_tiles_asked_for(const std::vector<std::uint32_t>& entries);
    void converge(const std::function<void(double)>& progress, double pixels, double pixels_before);
    void serve(std::vector<std::uint32_t> queries);
    void refine(Clock::time_point deadline);
    void require_lists() const;
    void look_ahead(Clock::time_point deadline);
    [[nodiscard]] PassResult march(PassKind kind);
    struct Serve {
        bool in_any_case = false;  ///< the first batch, though there be no time
        bool ahead = false;        ///< nothing loses its place which the last frame used
    };
    [[nodiscard]] bool serve_until(Clock::time_point deadline, const PassResult& pass, Serve how);
    void subdivide(std::uint32_t entry);
    [[nodiscard]] int draw_mix(const interop::MarchView& view, int row);
    void give_children(std::uint32_t entry);
    void request(std::uint32_t entry, bool may_stay);
    void restore_requests();
    void upload_nodes();
    void produce_requests();
    /// Where only a tile's own brick tells whether anything finer would show, that comes first.
    [[nodiscard]] bool wants_brick_first(std::uint32_t entry) const {
        return content->has_low_frequency() && tree.wants_children(entry) && !tree.was_produced(entry);
    }
    void keep_nothing();
    void keep_what_was_used_for(const View& view, Rows rows);
    [[nodiscard]] bool is_empty() const;
    [[nodiscard]] bool blends(const View& view) const;
    void note_caches(const FrameStatistics& before);
    [[nodiscard]] FrameStatistics totals() const;

    TreeShape shape;
    std::unique_ptr<Content> content;
    BrickPool pool;
    Tree tree;
    Marcher marcher;
    std::vector<Window> windows;  ///< of the frame; none where the shape has none
    std::vector<interop::MarchWindow> marched_windows;
    Mix mix;
    MarchMix drawn;  ///< of `mix`, around the band that is marched
    std::optional<BrickCache> cache;
    BatchPace batches;
    KeptPicture picture;
    TileQueries tile_queries = TileQueries::list;
    Refined refined;
    Ahead ahead;
    std::uint64_t prefetched = 0;   ///< since the last frame
    std::uint32_t frame_round = 1;  ///< what was used since is the last frame's
    std::uint32_t round = 1;
    std::vector<BrickRequest> requests;  // that wait to be produced together
    std::vector<std::uint32_t> requested_entries;
    FrameStatistics statistics;
};

}  // namespace cairn::renderer

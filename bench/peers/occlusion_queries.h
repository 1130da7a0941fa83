#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bench/peers/box_tests.h"
#include "bench/peers/view_tiles.h"
#include "gl/shader_source.h"
#include "optics/image.h"
#include "renderer/march/marcher.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "renderer/produce/tile_cache.h"
#include "renderer/renderer.h"
#include "renderer/view/view.h"
#include "shaders/interop/march.h"

namespace cairn::bench {

/// How tests alternate with production (Crassin 2007, section 3.6.1).
struct QuerySchedule {
    /// The least number of boxes under test at a time.
    int tests = 64;
    /// Bricks produced per box that is tested: f(n) = loads_per_test * n in the thesis. Above 0.
    double loads_per_test = 1.0;
    /// Whether a batch is tested while the bricks are produced that the tests before it found visible. The
    /// first batch is tested while the nearest bricks are produced, which are not tested. Otherwise each
    /// batch is drawn before the next one is tested: that takes fewer bricks, but production and tests wait
    /// for each other.
    bool overlapped = true;
};

/// Figures of one decision. Bricks are those of tiles that the oracle does not report as empty; some turn out
/// to be empty.
struct Visibility {
    std::uint64_t tiles_in_frustum = 0;
    std::uint64_t bricks_produced = 0;
    std::uint64_t queries = 0;
    int batches = 0;                ///< batches of production
    std::uint64_t bricks_used = 0;  ///< bricks that rays of the picture read
    std::uint64_t missed = 0;       ///< tiles that rays of the picture miss
    double milliseconds = 0.0;      ///< time from an empty tree to the picture
    optics::Image image;
};

/// Number of the view's tiles that remain after frustum culling and the oracle, each as fine as the view asks
/// for.
/// @throws Error (Fault::usage) as VisibleBricks does.
[[nodiscard]] std::size_t tiles_in_frustum(renderer::Content& content, const renderer::TreeShape& shape,
                                           const renderer::View& view);

/// Decides for one view which bricks to produce, without reports of rays: by the frustum alone, or by
/// occlusion queries on the tiles in it (Crassin 2007, sections 3.6 and 3.6.1: the tree is refined by
/// distance; its leaves are listed front to back; their boxes are tested against the depths at which the rays
/// through all bricks so far have become opaque). Between batches these depths are found by marching the
/// whole picture again through the bricks that are there; rays go through missing tiles. Only for surfaces
/// and primary rays, without shadows.
///
/// An object decides once, from an empty tree, because a fresh tree is part of the comparison.
class VisibleBricks {
public:
    /// @param brick_pool_bytes  bytes for all bricks that will be produced.
    /// @throws Error (Fault::usage) if the content is a volume, if rays of the view do not start at its eye,
    /// or if the picture is too large to be marched at once.
    VisibleBricks(std::unique_ptr<renderer::Content> content, const renderer::TreeShape& shape,
                  const renderer::View& view, std::size_t brick_pool_bytes, const gl::ShaderSource& shaders);

    /// Each produces bricks and renders the picture.
    /// @throws Error (Fault::usage) if a pool is too small.
    [[nodiscard]] Visibility by_frustum();
    [[nodiscard]] Visibility by_queries(const QuerySchedule& schedule);

private:
    using Tiles = std::span<const ViewTile>;
    void begin();
    void load(Tiles tiles);
    void draw();
    void load_and_draw(Tiles tiles);
    void test(Tiles tiles);
    [[nodiscard]] std::vector<ViewTile> visible_of(Tiles tested) const;
    void show();
    renderer::PassResult march(renderer::Marcher& marcher, renderer::PassKind kind);

    // First, so that it is checked before the content is used.
    interop::MarchView view_;
    renderer::TileCache cache_;
    ViewTest test_;
    renderer::Marcher saturate_;
    renderer::Marcher picture_;
    BoxTests boxes_;
    std::vector<ViewTile> tiles_;
    renderer::Round round_{1};
    Visibility result_;
};

}  // namespace cairn::bench

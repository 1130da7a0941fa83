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
#include "renderer/view/view.h"
#include "shaders/interop/march.h"

namespace cairn::bench {

/// How tests take turns with production (Crassin 2007, section 3.6.1).
struct QuerySchedule {
    /// Boxes under test at a time, at least.
    int tests = 64;
    /// f(n) = so many * n bricks are produced while n boxes are tested. Above 0.
    double loads_a_test = 1.0;
    /// Tests run while the bricks are produced that the tests before them found visible; the first run beside
    /// the nearest bricks, which are not tested. Else each batch is drawn before the next is tested: fewer
    /// bricks, and nobody works while the other does.
    bool overlapped = true;
};

/// What came of it. Bricks are those of tiles that the oracle does not know to be empty; some turn out to be.
struct Visibility {
    std::uint64_t tiles_in_frustum = 0;
    std::uint64_t bricks_produced = 0;
    std::uint64_t queries = 0;
    int batches = 0;                ///< of production
    std::uint64_t bricks_used = 0;  ///< that the rays of the picture read
    std::uint64_t missed = 0;       ///< tiles that they asked for in vain
    double milliseconds = 0.0;      ///< from an empty tree to the picture
    optics::Image image;
};

/// Tiles of the view that frustum culling and the oracle leave, each as fine as the view asks for.
/// @throws Error (Fault::usage) as VisibleBricks does.
[[nodiscard]] std::size_t tiles_in_frustum(renderer::Content& content, const renderer::TreeShape& shape,
                                           const renderer::View& view);

/// Decides for one view what to produce without asking rays: by the frustum alone, or by occlusion queries on
/// the tiles in it (Crassin 2007, sections 3.6 and 3.6.1: the tree is refined by distance; its leaves are
/// listed front to back; their boxes are tested against the depths at which the rays through all bricks so
/// far have become opaque). Between batches these depths are found by marching the whole picture again, with
/// what is there; tiles that are not there let rays through. Of surfaces, and primary rays alone: no shadows.
///
/// An object decides once, from an empty tree. A tree that nothing else has used before is part of the
/// comparison.
class VisibleBricks {
public:
    /// @param brick_pool_bytes  for all that will be produced.
    /// @throws Error (Fault::usage) for volumes, views whose rays do not start at the eye, and pictures that
    /// are too large to be marched at once.
    VisibleBricks(std::unique_ptr<renderer::Content> content, const renderer::TreeShape& shape,
                  const renderer::View& view, std::size_t brick_pool_bytes, const gl::ShaderSource& shaders);

    /// @throws Error (Fault::usage) when a pool is too small.
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

    interop::MarchView view_;  // checked before anything is made of the content
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

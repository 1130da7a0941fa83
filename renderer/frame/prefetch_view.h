#pragma once

#include "renderer/pool/tree_shape.h"
#include "renderer/view/view.h"

/// What is marched to prefetch: fewer rays than a picture has, and only some of its rows at a time.
namespace cairn::renderer {

/// So few that they can be marched at once. Each sees the levels that it would see in the whole picture.
[[nodiscard]] View thinned(const View& view);

/// One level finer. A brick of that level is hit by some ray.
[[nodiscard]] View finer(const View& view, const TreeShape& shape);

/// Bands from the middle of a picture outwards: who comes nearer sees that for longest. @return false behind
/// the last one.
[[nodiscard]] bool band_from_middle(const View& view, int number, Rows& rows);

}  // namespace cairn::renderer

#pragma once

#include "renderer/pool/tree_shape.h"
#include "renderer/view/view.h"

/// Views to prefetch for: they have fewer rays than the picture, and are marched some rows at a time.
namespace cairn::renderer {

/// The view with so few rays that they can be marched at once. Each ray sees the levels that it would see in
/// the whole picture.
[[nodiscard]] View thinned(const View& view);

/// The view one level finer. At least one ray hits each visible brick of that level.
[[nodiscard]] View finer(const View& view, const TreeShape& shape);

/// The rows of the band with this number, counted from the middle of the picture outwards: a camera that
/// moves closer sees the middle for longest.
/// @return  false if there is no band of that number.
[[nodiscard]] bool band_from_middle(const View& view, int number, Rows& rows);

}  // namespace cairn::renderer

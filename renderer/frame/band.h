#pragma once

#include <vector>

#include "renderer/march/marcher.h"
#include "renderer/march/windows.h"
#include "renderer/mesh/mix.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "renderer/view/view.h"
#include "shaders/interop/march.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// Rows of a picture that are marched at once, and all that their rays are told.
struct Band {
    interop::MarchView view;
    std::vector<Window> windows;  ///< around the eye; none where the shape has none
    std::vector<interop::MarchWindow> marched_windows;
    MarchMix mix;
    bool is_blended = false;  ///< rays see two mips at once
};

/// A band of the view, still without rows and mix.
/// @throws Error (Fault::usage) for a view that floats cannot tell, and for one that asks for blended levels
/// of detail of bricks without mips.
[[nodiscard]] Band make_band(const View& view, Content& content, const TreeShape& shape);

/// @param shown       SHOW_* of shaders/interop/march.h.
/// @param background  a pixel that shows nothing.
void set_rows(Band& band, Rows rows, int shown, std::uint32_t background);

/// Draws what the rays of a row meet beside voxels. @return the row behind the last that has been drawn.
[[nodiscard]] int draw_mix(Band& band, const Mix& mix, const voxelizer::Grid& grid, int row);

}  // namespace cairn::renderer

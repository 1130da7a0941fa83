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

/// Rows of a picture that are marched at once, and all that their rays need.
struct Band {
    interop::MarchView view;
    std::vector<Window> windows;                    ///< windows around the eye; empty if the tree has none
    std::vector<interop::MarchWindow> ray_windows;  ///< the windows as the shaders read them
    MixTextures mix;
    bool is_blended = false;  ///< rays see two mips of a brick at once
};

/// Makes a band of the view, without rows and mix.
/// @throws Error (Fault::usage) if floats cannot hold the view, or if it asks for blended levels of detail
///                              and bricks have no mips.
[[nodiscard]] Band make_band(const View& view, Content& content, const TreeShape& shape);

/// Sets the rows of the band, and what its pixels show.
/// @param shown       SHOW_* of shaders/interop/march.h.
/// @param background  value of a pixel that shows nothing.
void set_rows(Band& band, Rows rows, int shown, std::uint32_t background);

/// Draws what the rays of a row, and of the rows around it, meet beside voxels.
/// @return  the row behind the last one that was drawn.
[[nodiscard]] int draw_mix(Band& band, const Mix& mix, const voxelizer::Grid& grid, int row);

}  // namespace cairn::renderer

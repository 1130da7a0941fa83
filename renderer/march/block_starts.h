#pragma once

#include <vector>

#include "renderer/pool/tree.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// For each block of PIXEL_BLOCK_SIDE^2 pixels of the band: between which distances from the eye its rays may
/// meet anything, according to the node pool. Blocks that see nothing are left out, so that no ray is made
/// for them.
///
/// Conservative, so that the picture does not change: whatever a ray could show or ask for lies in the cells
/// of the tree that are not empty. Cells are taken no deeper than rays go, and the box of each cell is
/// projected with a margin. This serves the purpose of a beam pre-pass (rays of 1/8 resolution which march
/// ahead of the others), but projects cells as one draws proxy geometry: there are some hundred cells, and
/// thousands of beams.
///
/// Reads the CPU mirror of the tree: call it between Tree::upload() and the pass.
/// @param is_blended  rays see mips of bricks too.
[[nodiscard]] std::vector<interop::BlockStart> block_starts(const interop::MarchView& view, const Tree& tree,
                                                            bool is_blended);

/// Every block of the band, with rays that start at the eye and end behind everything.
[[nodiscard]] std::vector<interop::BlockStart> all_block_starts(const interop::MarchView& view);

/// Adds the blocks that `starts` leaves out, with rays of no length: for pictures that show more than voxels.
void add_empty_blocks(const interop::MarchView& view, std::vector<interop::BlockStart>& starts);

}  // namespace cairn::renderer

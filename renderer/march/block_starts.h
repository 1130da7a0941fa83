#pragma once

#include <vector>

#include "renderer/pool/tree.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// Between which distances from the eye the rays of each block of PIXEL_BLOCK_SIDE^2 pixels of the band may
/// meet anything, as far as the node pool tells: blocks that see nothing are left out, so that no ray is made
/// for them.
///
/// Conservative, so that the picture does not change: what a ray could show or ask for lies in the cells of
/// the tree that are not empty, taken no deeper than rays go, and the box of each is projected with a margin.
/// That is the purpose of a beam pre-pass (rays of 1/8 resolution which march ahead of the others), done the
/// other way round, as one draws proxy geometry: there are some hundred
/// cells where there are thousands of beams.
///
/// Reads the CPU mirror of the tree: call it between Tree::upload() and the pass.
/// @param is_blended  rays see mips too.
[[nodiscard]] std::vector<interop::BlockStart> block_starts(const interop::MarchView& view, const Tree& tree,
                                                            bool is_blended);

/// Every block of the band, and rays that start at the eye and end behind everything.
[[nodiscard]] std::vector<interop::BlockStart> all_block_starts(const interop::MarchView& view);

/// Adds the blocks that are left out, with nothing on their rays: for pictures that show more than voxels.
void add_empty_blocks(const interop::MarchView& view, std::vector<interop::BlockStart>& starts);

}  // namespace cairn::renderer

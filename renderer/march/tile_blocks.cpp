#include "renderer/march/tile_blocks.h"

#include <algorithm>

#include "shaders/interop/tile_query.h"

namespace cairn::renderer {

TileBlocks::TileBlocks(const gl::ShaderSource& shaders)
    : program_(gl::build_compute(shaders, "march/tile_blocks.comp.glsl", {})) {}

void TileBlocks::begin_frame(const glm::ivec2& size) {
    size_ = size;
    block_counts_ = (size + TILE_BLOCK_SIDE - 1) / TILE_BLOCK_SIDE;
    const std::size_t reports = std::size_t(size.x) * std::size_t(size.y) * sizeof(std::uint32_t);
    if (reports_.size_bytes() < reports) reports_ = gl::Buffer(reports, "tiles that rays left");
    const std::size_t blocks = std::size_t(block_counts_.x) * std::size_t(block_counts_.y) *
                               TILE_BLOCK_ENTRIES * sizeof(std::uint32_t);
    if (blocks_.size_bytes() < blocks) blocks_ = gl::Buffer(blocks, "tile queries of blocks");
}

void TileBlocks::begin_pass() {
    reports_.fill(0, std::size_t(size_.x) * std::size_t(size_.y) * sizeof(std::uint32_t), TILE_REPORT_NONE);
    reports_.bind_storage(SSBO_TILE_REPORTS);
}

TileBlocks::Reports TileBlocks::reduce() const {
    reports_.bind_storage(SSBO_TILE_REPORTS);
    blocks_.bind_storage(SSBO_TILE_BLOCKS);
    program_.set("size", size_);
    program_.use();
    glDispatchCompute(GLuint(block_counts_.x), GLuint(block_counts_.y), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);

    Reports out;
    const std::size_t words =
        std::size_t(block_counts_.x) * std::size_t(block_counts_.y) * TILE_BLOCK_ENTRIES;
    out.bytes_read = words * sizeof(std::uint32_t);
    for (const std::uint32_t word : blocks_.read_all<std::uint32_t>(words)) {
        if (word == TILE_REPORT_NONE) continue;
        if ((word & TILE_REPORT_USED) != 0) {
            out.slots.push_back(word & ~TILE_REPORT_USED);
        } else {
            out.queries.push_back(word);
        }
    }
    std::sort(out.queries.begin(), out.queries.end());
    out.queries.erase(std::unique(out.queries.begin(), out.queries.end()), out.queries.end());
    return out;
}

}  // namespace cairn::renderer

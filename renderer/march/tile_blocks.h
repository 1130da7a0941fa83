#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"

namespace cairn::renderer {

/// The reports of rays about tiles, by blocks of TILE_BLOCK_SIDE^2 pixels, and the compute pass that reduces
/// them to TILE_BLOCK_ENTRIES words per block (Crassin et al. 2008, section 5.3).
class TileBlocks {
public:
    explicit TileBlocks(const gl::ShaderSource& shaders);

    /// Sets the size of the band, in pixels; buffers grow when the bands do.
    void begin_frame(const glm::ivec2& size);

    /// Clears the reports of the last pass, and binds the words, one per pixel, that the rays of the next
    /// pass write.
    void begin_pass();

    struct Reports {
        std::vector<std::uint32_t> queries;  ///< query words (2 * entry + QUERY_*), each once, ascending
        std::vector<std::uint32_t> slots;    ///< slots of used bricks; a slot may occur more than once
        std::size_t bytes_read = 0;
    };
    /// Reduces the reports of a pass, and reads back only the words of the blocks.
    [[nodiscard]] Reports reduce() const;

private:
    gl::Program program_;
    gl::Buffer reports_;
    gl::Buffer blocks_;
    glm::ivec2 size_{0};
    glm::ivec2 block_counts_{0};
};

}  // namespace cairn::renderer

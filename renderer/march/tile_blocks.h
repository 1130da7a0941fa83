#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"

namespace cairn::renderer {

/// What the rays of a band tell of tiles, by blocks of TILE_BLOCK_SIDE^2 pixels, and the compute pass that
/// reduces it to TILE_BLOCK_ENTRIES words a block (Crassin et al. 2008, section 5.3).
class TileBlocks {
public:
    explicit TileBlocks(const gl::ShaderSource& shaders);

    /// Sets the size of the band, in pixels; buffers grow when the bands do.
    void begin_frame(const glm::ivec2& size);

    /// Forgets what the last pass told, and binds the word a pixel that the rays of the next one write.
    void begin_pass();

    struct Told {
        std::vector<std::uint32_t> queries;  ///< 2 * entry + QUERY_*, each once
        std::vector<std::uint32_t> slots;    ///< of bricks that were used; some more than once
        std::size_t bytes_read = 0;
    };
    /// After the rays of a pass: the only words that are read back.
    [[nodiscard]] Told reduce() const;

private:
    gl::Program program_;
    gl::Buffer reports_;
    gl::Buffer blocks_;
    glm::ivec2 size_{0};
    glm::ivec2 block_counts_{0};
};

}  // namespace cairn::renderer

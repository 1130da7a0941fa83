#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"
#include "shaders/interop/types.h"

namespace cairn::renderer {

/// What one pass of rays came back with.
struct PassResult {
    std::uint32_t waiting_primary = 0;        ///< rays that missed a tile
    std::uint32_t waiting_shadow = 0;         ///< the same, and shadow rays not yet started
    std::vector<std::uint32_t> queries;       ///< 2 * node entry + QUERY_*; each once
    std::vector<std::uint32_t> brick_stamps;  ///< one a slot: the last round whose rays used it
    [[nodiscard]] bool done() const { return waiting_primary == 0 && waiting_shadow == 0; }
};

/// The ray-marching passes of one frame: the ray states, the lists of rays that must go on, and the tile
/// query buffer (Crassin et al. 2008, sections 5.1 to 5.3).
class Marcher {
public:
    Marcher(const TreeShape& shape, bool has_color, const gl::ShaderSource& shaders);

    /// Sets the frame; buffers grow when the picture does.
    void begin_frame(const interop::MarchView& view, const Tree& tree, const BrickPool& pool);

    /// Runs every waiting ray until it ends or misses a tile. `round` is a number that grows with each pass.
    /// @throws Error when a ray hits the step limit: a fault of the marcher, never of the scene.
    [[nodiscard]] PassResult run_pass(std::uint32_t round, const Tree& tree, const BrickPool& pool);

    /// RGBA8, row 0 at the top.
    [[nodiscard]] std::vector<std::uint8_t> read_image() const;

private:
    void run(const gl::Program& program, std::uint32_t rays, bool first_pass, std::uint32_t round,
             const BrickPool& pool);
    [[nodiscard]] interop::MarchCounters read_counters() const;

    gl::Program primary_;
    gl::Program shadow_;
    gl::Buffer view_;
    gl::Buffer rays_;
    gl::Buffer lists_;
    gl::Buffer queries_;
    gl::Buffer usage_;
    gl::Buffer image_;
    glm::ivec2 size_{0};
    std::size_t capacity_ = 0;  // pixels that the buffers hold
    std::uint32_t query_bits_offset_ = 0;
    std::uint32_t waiting_primary_ = 0;
    std::uint32_t waiting_shadow_ = 0;
    bool first_pass_ = true;
    int list_side_ = 0;  // which half of the lists is read
};

}  // namespace cairn::renderer

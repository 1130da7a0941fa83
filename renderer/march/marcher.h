#pragma once

#include <array>
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

/// How rays take what is missing.
enum class PassKind : std::uint8_t {
    patient,      ///< a ray waits for the tile that it asks for
    progressive,  ///< the same; rays also ask for the bricks of the nodes that they pass
    stand_in,     ///< no ray waits: the nearest ancestor's brick is shown
};

/// What one pass of rays came back with.
struct PassResult {
    std::uint32_t waiting_primary = 0;  ///< rays that missed a tile or paused
    std::uint32_t waiting_shadow = 0;   ///< the same, and shadow rays not yet started
    std::uint32_t stood_in = 0;         ///< missing tiles that rays did not wait for
    /// 2 * node entry + QUERY_*, or 2 * Tree::entry_count() + entry for a brick that could stand in; each
    /// once.
    std::vector<std::uint32_t> queries;
    std::vector<std::uint32_t>
        query_counts;  ///< rays that ask, by query % QUERY_COUNTS; not of patient passes
    std::vector<std::uint32_t> brick_stamps;  ///< one a slot: the last round whose rays used it
    [[nodiscard]] bool done() const { return waiting_primary == 0 && waiting_shadow == 0; }
};

/// The ray-marching passes of one frame: the ray states, the lists of rays that must go on, and the tile
/// query buffer (Crassin et al. 2008, sections 5.1 to 5.3).
class Marcher {
public:
    Marcher(const TreeShape& shape, bool has_color, const gl::ShaderSource& shaders);

    /// Rows of a picture that are marched at once: as many as the driver's largest buffer holds ray states
    /// for.
    [[nodiscard]] static int band_rows(int width, int height);

    /// Sets the frame, or a band of it (`view.band`); buffers grow when the bands do.
    void begin_frame(const interop::MarchView& view, const Tree& tree, const BrickPool& pool);

    /// Runs every waiting ray until it ends, misses a tile, or has crossed so many cells that it pauses.
    /// `round` is a number that grows with each pass.
    /// @throws Error (Fault::internal) when rays wait though nothing is missing and none has paused, or pause
    /// without end.
    [[nodiscard]] PassResult run_pass(std::uint32_t round, const Tree& tree, const BrickPool& pool,
                                      PassKind kind = PassKind::patient);

    [[nodiscard]] int band_pixels() const { return size_.x * size_.y; }

    /// RGBA8, the band's first row first.
    [[nodiscard]] std::vector<std::uint8_t> read_image() const;

private:
    /// Built when a pass first asks for it.
    [[nodiscard]] const gl::Program& primary_program(PassKind kind);
    [[nodiscard]] const gl::Program& shadow_program(PassKind kind);
    struct Dispatch {
        const gl::Program& program;
        bool is_shadow = false;
        std::uint32_t rays = 0;
    };
    void run(const Dispatch& dispatch, std::uint32_t round, const BrickPool& pool, PassKind kind) const;
    [[nodiscard]] interop::MarchCounters read_counters() const;

    gl::ShaderSource shaders_;
    gl::Defines defines_;
    std::array<gl::Program, 8> primary_;  ///< PROGRESSIVE + 2 * SHOW_TREE + 4 * BLENDED
    std::array<gl::Program, 4> shadow_;   ///< PROGRESSIVE + 2 * BLENDED
    gl::Buffer view_;
    gl::Buffer rays_;
    gl::Buffer lists_;
    gl::Buffer queries_;
    gl::Buffer usage_;
    gl::Buffer image_;
    glm::ivec2 size_{0};
    std::size_t capacity_ = 0;  // pixels that the buffers hold
    std::uint32_t query_bits_offset_ = 0;
    std::uint32_t entry_count_ = 0;
    std::uint32_t waiting_primary_ = 0;
    std::uint32_t waiting_shadow_ = 0;
    bool first_pass_ = true;
    bool show_tree_ = false;
    bool blended_ = false;
    int pauses_ = 0;     // passes in a row in which rays only paused
    int list_side_ = 0;  // which half of the lists is read
};

}  // namespace cairn::renderer

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/march/march_options.h"
#include "renderer/march/tile_blocks.h"
#include "renderer/pool/round.h"
#include "renderer/produce/tile_query.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// The word that rays write for a query: query_word() in shaders/march/queries.glsl. It does not encode
/// TileQuery::rays.
/// @param entry_count  entries of the node pool.
[[nodiscard]] std::uint32_t query_word(const TileQuery& query, std::uint32_t entry_count);
/// The query that a word encodes, with TileQuery::rays 0.
[[nodiscard]] TileQuery query_of_word(std::uint32_t word, std::uint32_t entry_count);

/// The tile query buffer: the rays of a pass report there which tiles they miss and which bricks they use
/// (Crassin et al. 2008, section 5.3). Only this class and shaders/march/queries.glsl encode and decode it.
///
///     SSBO_QUERIES   MarchCounters
///                    words of the queries, in the order in which rays asked    QUERY_CAPACITY words
///                    rays that ask, by query word % QUERY_COUNTS               QUERY_COUNTS words
///                    of each rank, 1 + a query that found no room, or 0        QUERY_RANKS words
///     SSBO_USAGE     the last round that used each brick                       one word per slot
///                    whether any ray has asked, by query word                  one bit per word
///
/// With TileQueries::blocks, TileBlocks takes the place of SSBO_USAGE and of the list of words.
class QueryBuffer {
public:
    /// @param capacity     queries that a pass can report, [1, QUERY_CAPACITY].
    /// @param has_windows  rays go through windows; missing tiles of windows have ranks of their own.
    /// @throws Error (Fault::usage) if the capacity is out of range.
    QueryBuffer(int capacity, TileQueries how, bool has_windows, const gl::ShaderSource& shaders);

    /// Sets the size of the band, in pixels, and of the pools; buffers grow as needed.
    void begin_frame(const glm::ivec2& band, std::uint32_t entry_count, int slot_count);

    /// Clears the reports of the last pass, and binds the buffers that the rays of the next pass write.
    /// @param is_progressive  rays are counted, and may ask for bricks that could stand in.
    void begin_pass(bool is_progressive);

    /// Sets the uniforms that the rays of a program need to write their reports.
    void set(const gl::Program& program) const;

    /// What the rays of a pass reported.
    struct Reports {
        interop::MarchCounters counters{};
        std::vector<TileQuery> queries;           ///< each query once
        std::vector<std::uint32_t> brick_stamps;  ///< last round whose rays used the brick, one per slot
        std::size_t bytes_read = 0;
    };
    /// Reads the reports back.
    /// @param round  round of the pass.
    [[nodiscard]] Reports read(Round round);

private:
    void read_list(Reports& reports);
    void read_blocks(Reports& reports, Round round);
    [[nodiscard]] std::vector<std::uint32_t> read_urgent(Reports& reports);

    std::uint32_t capacity_;
    bool has_windows_;
    gl::Buffer words_;
    gl::Buffer usage_;  // empty with tile_blocks_
    std::optional<TileBlocks> tile_blocks_;
    std::vector<std::uint32_t> block_stamps_;  // one per slot, with tile_blocks_
    std::uint32_t slot_count_ = 0;
    std::uint32_t entry_count_ = 0;
    bool is_progressive_ = false;  // the pass counts rays
    bool has_urgent_ = true;       // the buffer holds queries by rank, of an earlier pass
};

}  // namespace cairn::renderer

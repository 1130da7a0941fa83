#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/march/tile_blocks.h"
#include "renderer/march/tile_queries.h"
#include "renderer/pool/round.h"
#include "renderer/produce/tile_query.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// The word that rays write for a query: query_word() in shaders/march/queries.glsl. `rays` is no part of it.
/// @param entry_count  of the node pool.
[[nodiscard]] std::uint32_t query_word(const TileQuery& query, std::uint32_t entry_count);
/// The query that a word stands for, with no rays counted.
[[nodiscard]] TileQuery query_of_word(std::uint32_t word, std::uint32_t entry_count);

/// The tile query buffer: what the rays of a pass tell of the tiles that they miss and the bricks that they
/// use (Crassin et al. 2008, section 5.3). Nothing else in C++ knows how that is coded; its twin is
/// shaders/march/queries.glsl.
///
///     SSBO_QUERIES   MarchCounters
///                    words of the queries, in the order in which rays asked    QUERY_CAPACITY words
///                    rays that ask, by query word % QUERY_COUNTS               QUERY_COUNTS words
///                    of each rank, 1 + a query that found no room, or 0        QUERY_RANKS words
///     SSBO_USAGE     the last round that used each brick                       a word per slot
///                    whether any ray has asked, by query word                  a bit per word
///
/// With TileQueries::blocks, TileBlocks takes the place of SSBO_USAGE and of the list of words.
class QueryBuffer {
public:
    /// @param capacity     queries that a pass can tell, [1, QUERY_CAPACITY].
    /// @param has_windows  rays go through windows, whose missing tiles have ranks of their own.
    /// @throws Error (Fault::usage) for a capacity out of range.
    QueryBuffer(int capacity, TileQueries how, bool has_windows, const gl::ShaderSource& shaders);

    /// Sets the size of the band, in pixels, and of the pools; buffers grow when they do.
    void begin_frame(const glm::ivec2& band, std::uint32_t entry_count, int slot_count);

    /// Forgets what the last pass told, and binds what the rays of the next one write.
    /// @param is_progressive  rays are counted, and may ask for what could stand in.
    void begin_pass(bool is_progressive);

    /// Tells a program of the pass where its rays write.
    void set(const gl::Program& program) const;

    /// What came back.
    struct Told {
        interop::MarchCounters counters{};
        std::vector<TileQuery> queries;           ///< each once
        std::vector<std::uint32_t> brick_stamps;  ///< of each slot, the last round whose rays used it
        std::size_t bytes_read = 0;
    };
    /// @param round  of the pass.
    [[nodiscard]] Told read(Round round);

private:
    void read_list(Told& told);
    void read_blocks(Told& told, Round round);
    [[nodiscard]] std::vector<std::uint32_t> read_urgent(Told& told);

    std::uint32_t capacity_;
    bool has_windows_;
    gl::Buffer words_;
    gl::Buffer usage_;  // none with tile_blocks_
    std::optional<TileBlocks> tile_blocks_;
    std::vector<std::uint32_t> block_stamps_;  // of slots, with tile_blocks_
    std::uint32_t slot_count_ = 0;
    std::uint32_t entry_count_ = 0;
    bool is_progressive_ = false;  // the pass
    bool urgent_told_ = true;      // the last pass left queries by rank
};

}  // namespace cairn::renderer

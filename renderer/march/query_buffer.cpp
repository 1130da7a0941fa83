#include "renderer/march/query_buffer.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "renderer/march/march_options.h"
#include "shaders/interop/tile_query.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {
namespace {

constexpr std::size_t word_bytes = sizeof(std::uint32_t);
constexpr std::size_t list_offset = sizeof(interop::MarchCounters);
static_assert(max_query_capacity == QUERY_CAPACITY, "the shaders hold another number of queries");
constexpr std::size_t counts_offset = list_offset + QUERY_CAPACITY * word_bytes;
constexpr std::size_t urgent_offset = counts_offset + QUERY_COUNTS * word_bytes;
constexpr std::size_t buffer_bytes = urgent_offset + QUERY_RANKS * word_bytes;
static_assert(QUERY_RANKS == QUERY_RANK_WINDOWS + 8 * MAX_WINDOWS);
static_assert(int(QueryKind::children) == QUERY_CHILDREN && int(QueryKind::brick) == QUERY_BRICK &&
              int(QueryKind::stand_in) == QUERY_STAND_IN);

}  // namespace

std::uint32_t query_word(const TileQuery& query, std::uint32_t entry_count) {
    if (query.kind == QueryKind::stand_in) return 2 * entry_count + query.entry;
    return 2 * query.entry + std::uint32_t(query.kind);
}

TileQuery query_of_word(std::uint32_t word, std::uint32_t entry_count) {
    if (word >= 2 * entry_count) return {word - 2 * entry_count, QueryKind::stand_in};
    return {word / 2, QueryKind(word % 2)};
}

QueryBuffer::QueryBuffer(int capacity, TileQueries how, bool has_windows, const gl::ShaderSource& shaders)
    : capacity_(std::uint32_t(capacity)),
      has_windows_(has_windows),
      words_(buffer_bytes, "tile query buffer") {
    if (capacity < 1 || capacity > QUERY_CAPACITY) {
        throw Error(Fault::usage, "tile queries", std::to_string(capacity) + " are out of range",
                    "choose between 1 and " + std::to_string(QUERY_CAPACITY));
    }
    if (how == TileQueries::blocks) tile_blocks_.emplace(shaders);
}

void QueryBuffer::begin_frame(const glm::ivec2& band, std::uint32_t entry_count, int slot_count) {
    slot_count_ = std::uint32_t(slot_count);
    entry_count_ = entry_count;
    if (tile_blocks_) {
        tile_blocks_->begin_frame(band);
        block_stamps_.resize(slot_count_);
        return;
    }
    const std::size_t usage_words = slot_count_ + (3 * std::size_t(entry_count) + 31) / 32;
    if (usage_.size_bytes() == usage_words * word_bytes) return;
    usage_ = gl::Buffer(usage_words * word_bytes, "brick usage");
    usage_.fill(0);
}

void QueryBuffer::begin_pass(bool is_progressive) {
    is_progressive_ = is_progressive;
    words_.fill(0, list_offset, 0);
    if (has_urgent_) words_.fill(urgent_offset, QUERY_RANKS * word_bytes, 0);
    has_urgent_ = false;
    words_.bind_storage(SSBO_QUERIES);
    if (tile_blocks_) {
        tile_blocks_->begin_pass();
        return;
    }
    // Stand-ins are asked for by progressive passes alone.
    const std::size_t query_words = ((is_progressive ? 3 : 2) * std::size_t(entry_count_) + 31) / 32;
    usage_.fill(slot_count_ * word_bytes, query_words * word_bytes, 0);
    usage_.bind_storage(SSBO_USAGE);
    if (is_progressive) words_.fill(counts_offset, QUERY_COUNTS * word_bytes, 0);
}

void QueryBuffer::set(const gl::Program& program) const {
    program.set("query_capacity", capacity_);
    program.set("usage_query_offset", slot_count_);
    if (is_progressive_) program.set("entry_count", entry_count_);
}

QueryBuffer::Reports QueryBuffer::read(Round round) {
    Reports reports;
    words_.read(0, &reports.counters, sizeof(reports.counters));
    reports.bytes_read = sizeof(reports.counters);
    if (tile_blocks_)
        read_blocks(reports, round);
    else
        read_list(reports);
    return reports;
}

void QueryBuffer::read_list(Reports& reports) {
    const std::uint32_t asked = reports.counters.queries;  // queries that rays made, in the list or not
    std::vector<std::uint32_t> words =
        words_.read_all<std::uint32_t>(std::min(asked, capacity_), list_offset);
    std::vector<std::uint32_t> counts;
    if (is_progressive_) counts = words_.read_all<std::uint32_t>(QUERY_COUNTS, counts_offset);
    reports.brick_stamps = usage_.read_all<std::uint32_t>(slot_count_);
    reports.bytes_read += (words.size() + counts.size() + reports.brick_stamps.size()) * word_bytes;
    if (asked > capacity_) {
        const std::vector<std::uint32_t> urgent = read_urgent(reports);
        words.insert(words.end(), urgent.begin(), urgent.end());
    }
    for (const std::uint32_t word : words) {
        TileQuery& query = reports.queries.emplace_back(query_of_word(word, entry_count_));
        if (is_progressive_) query.rays = counts[word % QUERY_COUNTS];
    }
}

void QueryBuffer::read_blocks(Reports& reports, Round round) {
    const TileBlocks::Reports blocks = tile_blocks_->reduce();
    reports.bytes_read += blocks.bytes_read;
    for (const std::uint32_t slot : blocks.slots)
        block_stamps_[slot] = round.number;
    reports.brick_stamps = block_stamps_;
    for (const std::uint32_t word : blocks.queries)
        reports.queries.push_back(query_of_word(word, entry_count_));
    for (const std::uint32_t word : read_urgent(reports)) {
        if (!std::binary_search(blocks.queries.begin(), blocks.queries.end(), word))
            reports.queries.push_back(query_of_word(word, entry_count_));
    }
}

/// Reads one query per rank, of those that found no room in the list.
std::vector<std::uint32_t> QueryBuffer::read_urgent(Reports& reports) {
    has_urgent_ = true;
    const std::size_t ranks = has_windows_ ? QUERY_RANKS : QUERY_RANK_WINDOWS;
    reports.bytes_read += ranks * word_bytes;
    std::vector<std::uint32_t> words;
    for (const std::uint32_t word : words_.read_all<std::uint32_t>(ranks, urgent_offset)) {
        if (word != 0) words.push_back(word - 1);
    }
    return words;
}

}  // namespace cairn::renderer

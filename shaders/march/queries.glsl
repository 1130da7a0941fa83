// The reports of rays to the cache: tiles that they miss, and bricks that they used.
#include "interop/tile_query.h"

// The word that encodes a query. Its twin is query_word() of renderer/march/query_buffer.h.
uint query_word(uint entry, uint kind) {
#if PROGRESSIVE
    if (kind == uint(QUERY_STAND_IN)) return 2u * entry_count + entry;
#endif
    return 2u * entry + kind;
}

// Keeps one query per rank of those that find no room. Without it, the same queries might find room in each
// pass, and a ray might wait for ever: while its next tile waits, tiles that it had been given make way for
// theirs.
void keep_urgent(uint word, int rank) {
    const uint place = uint(QUERY_CAPACITY + QUERY_COUNTS + rank);
    if (queries[place] == 0u) atomicMax(queries[place], word + 1u);
}

#if TILE_BLOCKS
// Reports by blocks of pixels: each ray leaves the last tile that it missed, or else the last brick that it
// used (Crassin et al. 2008, section 5.3).
uint tile_report = TILE_REPORT_NONE;

void query(uint entry, uint kind, int rank) {
    tile_report = query_word(entry, kind);
    keep_urgent(tile_report, rank);
}

void touch(int slot) { tile_report = TILE_REPORT_USED | uint(slot); }

// A pixel has one ray in each pass.
void leave_report(uint pixel) { tile_reports[pixel] = tile_report; }
#else
// Reports by a list of words, and a bit per word, behind the stamps of the slots, that marks whether any ray
// has made the query.
// @return false if there was no room for the query.
bool ask(uint word) {
#if PROGRESSIVE
    // Counts the rays that make a query. Several tiles may share a count, which only affects the order of
    // their production.
    atomicAdd(queries[uint(QUERY_CAPACITY) + word % uint(QUERY_COUNTS)], 1u);
#endif
    const uint old = atomicOr(usage[usage_query_offset + word / 32u], 1u << (word % 32u));
    if ((old >> (word % 32u) & 1u) != 0u) return true;  // another ray has made the query
    const uint place = atomicAdd(counters.queries, 1u);
    if (place >= query_capacity) return false;
    queries[place] = word;
    return true;
}

void query(uint entry, uint kind, int rank) {
    const uint word = query_word(entry, kind);
    if (!ask(word)) keep_urgent(word, rank);
}

// Marks the brick as used by this pass.
void touch(int slot) {
    if (usage[slot] != pass_number) atomicMax(usage[slot], pass_number);
}

void leave_report(uint pixel) {}
#endif

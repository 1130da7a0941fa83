// What rays tell the cache: what they miss, and what they used.
#include "interop/tile_query.h"

// The number that a query is told by. Its twin is query_word() of renderer/march/query_buffer.h.
uint query_word(uint entry, uint kind) {
#if PROGRESSIVE
    if (kind == uint(QUERY_STAND_IN)) return 2u * entry_count + entry;
#endif
    return 2u * entry + kind;
}

// The last resort of queries for which there is no room: without it the same ones might get it in each pass,
// and a ray whose data was to come next lose what it had been given to those that ask in between.
void keep_urgent(uint word, int rank) {
    const uint place = uint(QUERY_CAPACITY + QUERY_COUNTS + rank);
    if (queries[place] == 0u) atomicMax(queries[place], word + 1u);
}

#if TILE_BLOCKS
// By blocks of pixels: each ray leaves the last tile that it missed, or else the last brick that it used
// (Crassin et al. 2008, section 5.3).
uint tile_report = TILE_REPORT_NONE;

void query(uint entry, uint kind, int rank) {
    tile_report = query_word(entry, kind);
    keep_urgent(tile_report, rank);
}

void touch(int slot) { tile_report = TILE_REPORT_USED | uint(slot); }

// A pixel has one ray in each pass.
void leave_report(uint pixel) { tile_reports[pixel] = tile_report; }
#else
// By a list of words, and a bit for each, behind the stamps of the slots, that says whether any ray has
// asked. @return false when there was no room for it.
bool ask(uint word) {
#if PROGRESSIVE
    // How many rays ask: several tiles may share a count, which only disturbs the order of their production.
    atomicAdd(queries[uint(QUERY_CAPACITY) + word % uint(QUERY_COUNTS)], 1u);
#endif
    const uint old = atomicOr(usage[usage_query_offset + word / 32u], 1u << (word % 32u));
    if ((old >> (word % 32u) & 1u) != 0u) return true;  // another ray has asked
    const uint place = atomicAdd(counters.queries, 1u);
    if (place >= query_capacity) return false;
    queries[place] = word;
    return true;
}

void query(uint entry, uint kind, int rank) {
    const uint word = query_word(entry, kind);
    if (!ask(word)) keep_urgent(word, rank);
}

// Tells the cache that this pass used the brick.
void touch(int slot) {
    if (usage[slot] != pass_number) atomicMax(usage[slot], pass_number);
}

void leave_report(uint pixel) {}
#endif

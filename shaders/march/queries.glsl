// What rays tell the cache: what they miss, and what they used.
// The tile query buffer holds 2 * entry + kind, or 2 * entry_count + entry for a brick that could stand in.
void ask(uint bit) {
#if PROGRESSIVE
    // How many rays ask: several tiles may share a count, which only disturbs the order of their production.
    atomicAdd(queries[uint(QUERY_CAPACITY) + bit % uint(QUERY_COUNTS)], 1u);
#endif
    const uint old = atomicOr(usage[usage_query_offset + bit / 32u], 1u << (bit % 32u));
    if ((old >> (bit % 32u) & 1u) != 0u) return;  // another ray has asked
    const uint place = atomicAdd(counters.queries, 1u);
    if (place < query_capacity) queries[place] = bit;
}

void query(uint entry, uint kind) { ask(2u * entry + kind); }

// Tells the cache that this pass used the brick.
void touch(int slot) {
    if (usage[slot] != pass_number) atomicMax(usage[slot], pass_number);
}

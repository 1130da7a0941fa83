// Tile queries: what rays report to the cache, and how they report it (shaders/march/queries.glsl).
#ifndef CAIRN_INTEROP_TILE_QUERY_H
#define CAIRN_INTEROP_TILE_QUERY_H

#define SSBO_QUERIES 2       // MarchCounters, then the tile query buffer
// The last pass that used each brick; then bits: queries already made in this pass.
#define SSBO_USAGE 3
#define SSBO_TILE_REPORTS 3  // a word per pixel, in place of SSBO_USAGE where rays report by blocks of pixels
// TILE_BLOCK_ENTRIES words per block (the pass that reduces them, which reads no block starts).
#define SSBO_TILE_BLOCKS 5

// The tile queries of one pass; what finds no room is asked for again by the next pass.
#define QUERY_CAPACITY 65536
// Counts of the rays that ask, behind the queries; a query's is number query % QUERY_COUNTS.
#define QUERY_COUNTS 65536
#define QUERY_CHILDREN 0  // the node must be subdivided
#define QUERY_BRICK 1     // the node's brick must be produced
#define QUERY_STAND_IN 2  // the node's brick could stand in for what is missing below it
// Of the queries that find no room, one of each rank is kept, behind the counts: for the children of a node,
// the rank is its level; then bricks; then the missing tiles of windows, each its own. So the CPU always
// learns of the most urgent one.
#define QUERY_RANK_BRICK 63
#define QUERY_RANK_WINDOWS 64
#define QUERY_RANKS 576

// What rays report by blocks of pixels (shaders/march/tile_blocks.comp.glsl): a query, or the slot of a brick
// that was used.
#define TILE_BLOCK_SIDE 16
#define TILE_BLOCK_ENTRIES 4
#define TILE_REPORT_NONE 4294967295u
#define TILE_REPORT_USED 2147483648u  // plus the slot

#endif

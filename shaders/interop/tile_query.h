// Tile queries: the reports of rays to the cache, and their buffers (shaders/march/queries.glsl).
#ifndef CAIRN_INTEROP_TILE_QUERY_H
#define CAIRN_INTEROP_TILE_QUERY_H

#define SSBO_QUERIES 2       // MarchCounters, then the tile query buffer
// A word per slot: the last pass that used its brick; then one bit per query: whether it was made in this
// pass.
#define SSBO_USAGE 3
#define SSBO_TILE_REPORTS 3  // a word per pixel, instead of SSBO_USAGE if rays report by blocks of pixels
// TILE_BLOCK_ENTRIES words per block, written by the pass that reduces reports, which reads no block starts.
#define SSBO_TILE_BLOCKS 5

// Tile queries that one pass has room for; the next pass repeats queries that found no room.
#define QUERY_CAPACITY 65536
// Counts of the rays that make a query, behind the queries. The count of a query has the number query %
// QUERY_COUNTS.
#define QUERY_COUNTS 65536
#define QUERY_CHILDREN 0  // the node must be subdivided
#define QUERY_BRICK 1     // the node's brick must be produced
#define QUERY_STAND_IN 2  // the node's brick could stand in for what is missing below it
// Of the queries that find no room, one per rank is kept, behind the counts, so that the CPU always gets the
// most urgent one. The rank of a query for the children of a node is the node's level; bricks have one rank,
// and each missing tile of a window has its own.
#define QUERY_RANK_BRICK 63
#define QUERY_RANK_WINDOWS 64
#define QUERY_RANKS 576

// Reports of rays by blocks of pixels (shaders/march/tile_blocks.comp.glsl): a query, or the slot of a brick
// that was used.
#define TILE_BLOCK_SIDE 16
#define TILE_BLOCK_ENTRIES 4
#define TILE_REPORT_NONE 4294967295u
#define TILE_REPORT_USED 2147483648u  // this plus the slot of a brick that was used

#endif

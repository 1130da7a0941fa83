// The producers: the tiles whose bricks are being produced, and the data that is gathered for them (beside
// the surface's bindings 0 to 4).
#ifndef CAIRN_INTEROP_PRODUCE_H
#define CAIRN_INTEROP_PRODUCE_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define SSBO_BRICK_PAIRS 5    // BrickPair: which triangle touches which tile of the batch
#define SSBO_BRICK_TILES 6    // BrickTile, or FractalTile: the tiles of the batch
#define SSBO_BRICK_SCRATCH 7  // masks, then sums, of every voxel of the batch (shaders/produce/scratch.glsl)
// Bindings of the passes that resolve, which read no surface.
#define SSBO_BRICK_MASKS 0    // masks and summaries of the brick pool
#define IMAGE_BRICK_COLOR 0
#define IMAGE_BRICK_NORMAL 1
#define IMAGE_BRICK_WORDS 0       // the words of all packed bricks
#define SSBO_BRICK_HEADS 0        // the heads of the batch's packed bricks, HEAD_WORDS each
#define SSBO_BRICK_COUNTS 1       // PackedCount per tile of the batch
#define SSBO_BRICK_RECORDS 3      // where the voxels of the batch's records are
#define SSBO_BRICK_MARKED 2       // which records keep their marks (shaders/produce/records.glsl)

#ifdef __cplusplus
namespace cairn::interop {
#endif

// A tile whose brick is being produced.
struct BrickTile {
    ivec3 low;      // low corner without the border, in voxels of the tile's level
    // log2 of a voxel's side in lattice units; the side itself if N = 3.
    int size;
    uint first_word;    // where the brick lies in the pool, or NO_ROOM
    uint first_record;  // records of the tiles before this one
    int padding1, padding2;
};

// A tile of the fractal (renderer/produce/fractal_content.h) whose brick is being produced.
struct FractalTile {
    // First texel of the slot in the pool's textures, border included.
    ivec3 first_texel;
    int slot;
    uint neighbours;    // bit x + 3 (y + 3 z): the tile (x, y, z) - 1 away is not empty
    uint padding1, padding2, padding3;
};

// What a packed brick needs room for.
struct PackedCount {
    uint records;   // occupied voxels of all mips, border included
    uint words;     // all words of the brick; 0: no voxel is occupied, and none is needed
};
#define NO_ROOM 0xFFFFFFFFu  // in BrickTile.first_word: the brick is not stored

#define PAIR_MOST_ROWS 64  // rows of a BrickPair at most

// A triangle that may touch a tile of the batch.
struct BrickPair {
    uint triangle;      // number in the bound surface chunk
    uint tile_mip;      // tile of the batch | mip << 16
    // Rows of the mip, border included: first y | count of y << 8 | first z << 16 | count of z << 24.
    uint rows;
};

#ifdef __cplusplus
static_assert(sizeof(BrickTile) == 32, "GLSL sees another layout");
static_assert(sizeof(FractalTile) == 32, "GLSL sees another layout");
static_assert(sizeof(BrickPair) == 12, "GLSL sees another layout");
static_assert(sizeof(PackedCount) == 8, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

// The pairs of a batch: threads are pairs of a triangle and some rows of a mip of a tile that it may touch.
#include "interop/produce.h"
#include "produce/scratch.glsl"

layout(std430, binding = SSBO_BRICK_PAIRS) readonly buffer PairBlock { BrickPair pairs[]; };

uniform uint pair_count;

struct PairRows {
    uint triangle;    // number in the bound surface chunk
    uint tile;        // number in the batch
    int mip;
    int size;         // as BrickTile.size, of the mip's voxels; only trees of powers of two have mips
    ivec3 low, high;  // the rows' voxels, in the mip's level
    ivec3 region;     // low corner of the mip's border
};

PairRows pair_rows(uint i) {
    PairRows r;
    r.triangle = pairs[i].triangle;
    r.tile = pairs[i].tile_mip & 0xFFFFu;
    r.mip = int(pairs[i].tile_mip >> 16);
    const ivec2 first_row = ivec2(pairs[i].rows & 0xFFu, pairs[i].rows >> 16 & 0xFFu);
    const ivec2 row_count = ivec2(pairs[i].rows >> 8 & 0xFFu, pairs[i].rows >> 24);
    r.size = tiles[r.tile].size + r.mip;
    r.region = (tiles[r.tile].low >> r.mip) - 1;
    r.low = r.region + ivec3(0, first_row);
    r.high = r.region + ivec3(MIP_SIDE(r.mip) - 1, first_row + row_count - 1);
    return r;
}

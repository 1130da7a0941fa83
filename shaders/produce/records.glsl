// The records of a batch's new bricks: threads are records, brick after brick.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/heads.glsl"

// The bricks' tables, one behind the other: table_of().
layout(std430, binding = SSBO_BRICK_MARKED) buffer MarkedBlock { uvec2 marked[]; };

uniform uint tile_count;
uniform uint record_count;  // of all tiles

// Where each record's voxel is, as the first of the passes leaves it for those behind it.
layout(std430, binding = SSBO_BRICK_RECORDS) buffer RecordBlock { uvec2 record_places[]; };

uint tile_of_record(uint record) {
    uint low = 0u;
    for (uint end = tile_count; end - low > 1u;) {
        const uint middle = (low + end) / 2u;
        if (tiles[middle].first_record <= record) low = middle;
        else end = middle;
    }
    return low;
}

// The last group whose records do not begin behind this record of the tile.
int group_of_record(uint tile, uint record) {
    const uint ranks = tile * uint(HEAD_WORDS) + uint(HEAD_RANKS);
    int low = 0;
    for (int end = GROUPS; end - low > 1;) {
        const int middle = (low + end) / 2;
        if (heads[ranks + uint(middle)] <= record) low = middle;
        else end = middle;
    }
    return low;
}

struct Record {
    uint tile;
    uint number;  // in its brick
    bool is_in_table;
    uint voxel;  // number in the scratch
};

#define RECORD_IN_TABLE 0x80000000u

Record record_at(uint i) {
    const uvec2 place = record_places[i];
    Record r;
    r.tile = place.y & ~RECORD_IN_TABLE;
    r.number = i - tiles[r.tile].first_record;
    r.is_in_table = (place.y & RECORD_IN_TABLE) != 0u;
    r.voxel = place.x;
    return r;
}

// Finds the voxel of a record, and leaves it.
Record find_record(uint i) {
    Record r;
    r.tile = tile_of_record(i);
    r.number = i - tiles[r.tile].first_record;
    GroupBit at = GroupBit(group_of_record(r.tile, r.number), 0);
    const uint rank = heads[r.tile * uint(HEAD_WORDS) + uint(HEAD_RANKS + at.group)];
    at.bit = bit_of_rank(head_mask(r.tile, SUMMARY_WORDS + at.group), int(r.number - rank));
    const int mip = mip_of_group(at.group);
    r.is_in_table = at.group < TABLE_GROUPS;
    r.voxel = scratch_voxel(r.tile, mip, voxel_of_bit(at, mip) + 1);
    record_places[i] = uvec2(r.voxel, r.tile | (r.is_in_table ? RECORD_IN_TABLE : 0u));
    return r;
}

uvec2 marks_of(Record r) { return uvec2(scratch[2u * r.voxel], scratch[2u * r.voxel + 1u]); }

uint sums_of(Record r) { return sums_offset + r.voxel * uint(SUM_WORDS); }

// Number of the tile's first entry of `marked`.
uint table_of(uint tile) { return (tiles[tile].first_record >> 5) + tile; }

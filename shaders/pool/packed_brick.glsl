// A packed brick (renderer/pool/packed_bricks.h): a head, and behind it a record for each occupied voxel, of
// all mips, border included. Its 32-bit words are numbered from the brick's first one.
//
//     head      2 words for each 64-bit word of the masks: the summary and the mask blocks of all mips, as in
//               brick_masks.glsl, then the borders of all mips, 64 voxels in a word (border_number())
//               1 word for each mask block and each 64 voxels of a border: the number of the first record
//               1 word: where the table begins
//     records   RECORD_WORDS for each occupied voxel, in the order of the masks' bits: its normals and its slab
//               (brick_normals.glsl, slab.glsl) and, with HAS_COLOR, its colour and coverage (RGBA8)
//     table     2 words for 32 records: a bit for each, whether its marks are kept, and where the first of their
//               marks is. If marks are not kept, the slab tells as much. With HAS_COLOR the table has the records
//               of the mask blocks alone; else all, for what lies in a voxel tells the coverage
//     marks     2 words each: 4^3 finer voxels, bit x + 4 (y + 4 z)
//
// A group is a mask block, or 64 voxels of a border. Needs the define GROUPS, and those of brick_masks.glsl.
#include "pool/brick_masks.glsl"

#define HEAD_MASKS 0
#define HEAD_RANKS (2 * (SUMMARY_WORDS + GROUPS))
#define HEAD_TABLE (HEAD_RANKS + GROUPS)
#define HEAD_WORDS (HEAD_TABLE + 1)
#define INNER_GROUPS (MASK_WORDS - SUMMARY_WORDS)
#if HAS_COLOR
#define RECORD_WORDS 2
#define TABLE_GROUPS INNER_GROUPS
#else
#define RECORD_WORDS 1
#define TABLE_GROUPS GROUPS
#endif

#define BORDER_SIDE(mip) (MIP_M(mip) + 2)
#define BORDER_VOXELS(mip) (CUBE(BORDER_SIDE(mip)) - CUBE(MIP_M(mip)))
#define BORDER_GROUPS(mip) ((BORDER_VOXELS(mip) + 63) / 64)

// Group of the first voxels of a mip's border.
int first_border_group(int mip) {
    int first = INNER_GROUPS;
    for (int k = 0; k < mip; ++k) first += BORDER_GROUPS(k);
    return first;
}

// Number of a voxel in its mip's border: the layers below and above, the rows before and behind, the rest.
// `v`: place in the mip, [-1, MIP_M(mip)], with a coordinate at an end.
int border_number(ivec3 v, int mip) {
    const int m = MIP_M(mip);
    const int side = m + 2;
    const ivec3 end = ivec3(equal(v, ivec3(m)));
    if (v.z < 0 || v.z == m) return end.z * side * side + (v.y + 1) * side + v.x + 1;
    if (v.y < 0 || v.y == m) return 2 * side * side + v.z * 2 * side + end.y * side + v.x + 1;
    return 2 * side * side + m * 2 * side + (v.z * m + v.y) * 2 + end.x;
}

// The voxel of a number in its mip's border.
ivec3 border_voxel(int number, int mip) {
    const int m = MIP_M(mip);
    const int side = m + 2;
    if (number < 2 * side * side) {
        const int rest = number % (side * side);
        return ivec3(rest % side - 1, rest / side - 1, number < side * side ? -1 : m);
    }
    number -= 2 * side * side;
    if (number < 2 * side * m) {
        const int rest = number % (2 * side);
        return ivec3(rest % side - 1, rest < side ? -1 : m, number / (2 * side));
    }
    number -= 2 * side * m;
    return ivec3(number % 2 == 0 ? -1 : m, number / 2 % m, number / 2 / m);
}

// Where the occupancy of a voxel is kept.
struct GroupBit {
    int group;
    int bit;
};

// Of a voxel that is not in the border.
GroupBit inner_group_bit(ivec3 v, int mip) {
    const int blocks = MIP_BLOCKS_PER_SIDE(mip);
#if BLOCK_SIDE == 4
    const ivec3 c = v >> 2;
#else
    const ivec3 c = v / BLOCK_SIDE;
#endif
    const ivec3 place = v - BLOCK_SIDE * c;
    return GroupBit(first_mask_of(mip) - SUMMARY_WORDS + c.x + blocks * (c.y + blocks * c.z),
                    place.x + BLOCK_SIDE * (place.y + BLOCK_SIDE * place.z));
}

GroupBit group_bit(ivec3 v, int mip) {
    const int m = MIP_M(mip);
    if (all(greaterThanEqual(v, ivec3(0))) && all(lessThan(v, ivec3(m)))) return inner_group_bit(v, mip);
    const int number = border_number(v, mip);
    return GroupBit(first_border_group(mip) + number / 64, number % 64);
}

// Mip of a group's voxels.
int mip_of_group(int group) {
    int mip = 0;
    if (group < INNER_GROUPS) {
        while (mip < BRICK_MIPS && group + SUMMARY_WORDS >= first_mask_of(mip + 1)) ++mip;
    } else {
        while (mip < BRICK_MIPS && group >= first_border_group(mip + 1)) ++mip;
    }
    return mip;
}

// Place in its mip of the voxel whose occupancy is a group's bit.
ivec3 voxel_of_bit(GroupBit at, int mip) {
    if (at.group >= INNER_GROUPS) return border_voxel(64 * (at.group - first_border_group(mip)) + at.bit, mip);
    const int blocks = MIP_BLOCKS_PER_SIDE(mip);
    const int block = at.group + SUMMARY_WORDS - first_mask_of(mip);
    const ivec3 c = ivec3(block % blocks, block / blocks % blocks, block / (blocks * blocks));
    const ivec3 place = ivec3(at.bit % BLOCK_SIDE, at.bit / BLOCK_SIDE % BLOCK_SIDE, at.bit / (BLOCK_SIDE * BLOCK_SIDE));
    return BLOCK_SIDE * c + place;
}

bool has_bit(uvec2 mask, int bit) { return ((bit < 32 ? mask.x : mask.y) >> (bit & 31) & 1u) != 0u; }

// Number of bits below a bit.
int bits_below(uvec2 mask, int bit) {
    const uint below = (1u << (bit & 31)) - 1u;
    return bit < 32 ? bitCount(mask.x & below) : bitCount(mask.x) + bitCount(mask.y & below);
}

// The bit that has `below` bits below it.
int bit_of_rank(uvec2 mask, int below) {
    const int in_low = bitCount(mask.x);
    const bool is_low = below < in_low;
    uint rest = is_low ? mask.x : mask.y;
    int left = is_low ? below : below - in_low;
    int bit = is_low ? 0 : 32;
    for (int width = 16; width > 0; width >>= 1) {
        const int count = bitCount(rest & (1u << width) - 1u);
        if (left < count) continue;
        left -= count;
        bit += width;
        rest >>= width;
    }
    return bit;
}

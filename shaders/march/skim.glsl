// Skips the empty cells of a brick, by its masks.

// Block c of a brick: -1 if it is not empty, else log2 of the side, in blocks, of an empty aligned cell
// around it.
int empty_block_shift(int brick, uvec2 summary, ivec3 c) {
#if BLOCKS_PER_SIDE == 4
    return empty_shift_4(summary, c);
#elif BLOCKS_PER_SIDE == 2
    return empty_shift_2(summary.x, c);
#else
    const int block = c.x + BLOCKS_PER_SIDE * (c.y + BLOCKS_PER_SIDE * c.z);
    const uvec2 word = mask_word(brick, block / 64);
    return ((block % 64 < 32 ? word.x : word.y) >> (block % 32) & 1u) != 0u ? -1 : 0;
#endif
}

#define SKIM_OCCUPIED 0  // the ray's voxel is occupied
#define SKIM_LEFT 1      // the ray left the tile, or now sees other mips of it
#define SKIM_ENDED 2     // the ray is done

// Moves the ray over the empty cells of a brick to an occupied voxel.
int skim(inout Ray ray, Place place, inout int turns) {
    const int brick_voxel_shift = brick_voxel_shift_of(place);
#if BLENDED
    const int mip = place.mip + 1;
#else
    const int mip = 0;
#endif
    const int blocks = MIP_BLOCKS_PER_SIDE(mip);
    const ivec3 tile = cell_of(ray.cell, place.tile_shift);
    const int first_mask = first_mask_of(mip);
    // A straight line crosses at most 3 M - 2 cells of a brick.
    for (int cell = 0; cell < 3 * BRICK_M; ++cell) {
        ++turns;
        ivec3 b = place_in(ray.cell, brick_voxel_shift, M_SHIFT);
        ivec3 c = cell_of(b, BLOCK_SHIFT);
        int empty = empty_block_shift(place.brick, place.summary, c);
        int shift = brick_voxel_shift + BLOCK_SHIFT + empty;
        if (empty < 0) {
#if BLENDED
            b = cell_of(b, mip);
            c = cell_of(b, BLOCK_SHIFT);
#endif
            const uvec2 mask = mask_word(place.brick, first_mask + c.x + blocks * (c.y + blocks * c.z));
            empty = empty_voxel_shift(mask, b - cell_low(b, BLOCK_SHIFT));
            if (empty < 0) return SKIM_OCCUPIED;
            shift = min(brick_voxel_shift + mip + empty, brick_voxel_shift + M_SHIFT);
        }
        if (!step_over(ray, shift)) return SKIM_ENDED;
        if (any(notEqual(cell_of(ray.cell, place.tile_shift), tile))) return SKIM_LEFT;
#if BLENDED
        if (needs_coarser(ray, place)) return SKIM_LEFT;  // other mips may be occupied here
#endif
    }
    return SKIM_LEFT;
}

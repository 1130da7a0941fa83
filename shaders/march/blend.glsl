// Between two mips (Crassin et al. 2008, section 4.3). The size that the ray should see (blended_size.glsl)
// lies between the sides of the voxels of the brick's mip and of the next one: the ray walks the coarser
// cells, takes the coarse voxel with weight f and the finer ones in the same cell with 1 - f, so that their
// mean side is that size. At f = 0 and 1 that is the march of one mip alone; where f comes to 1 the next pair
// of mips begins with 0, for what the next mip (or the parent's brick) holds is the same. A voxel stays a
// sheet: it gives its share once. Shares add up, so their weighted sum is opaque wherever both mips are.
//
// f is one for the whole coarse cell, and linear in the size: no logarithm, whose last bits drivers differ
// in.

bool is_occupied(ivec3 voxel, Place place, int mip) {
    const ivec3 b = place_in(voxel, brick_voxel_shift_of(place) + mip, M_SHIFT - mip);
    const ivec3 c = cell_of(b, BLOCK_SHIFT);
    const int blocks = MIP_BLOCKS_PER_SIDE(mip);
    const int word = place.slot * MASK_WORDS + first_mask_of(mip) + c.x + blocks * (c.y + blocks * c.z);
    return empty_voxel_shift(texelFetch(brick_masks, word).xy, b - cell_low(b, BLOCK_SHIFT)) < 0;
}

// Takes the occupied coarse cell around the ray's voxel; as take_voxel().
bool take_both(inout Ray ray, Place place, out bool goes_on) {
    const int fine_shift = voxel_shift_of(place);
    const float side = float(cell_side(fine_shift));
#if PROGRESSIVE
    const bool blends = place.brick_shift == place.tile_shift;  // what stands in does not
#else
    const bool blends = true;
#endif
    const float size = blended_size(brick_voxel_shift_of(place), width_at_cell(ray, fine_shift + 1));
    const float f = blends ? clamp(size / side - 1.0, 0.0, 1.0) : 0.0;
    const ivec3 cell = cell_of(ray.voxel, fine_shift + 1);
    goes_on = true;
    if (f > 0.0) {
        Ray whole = ray;
        if (!take_voxel(whole, place, place.mip + 1, f, goes_on)) return false;
        if (f >= 1.0) {
            ray = whole;
            return true;
        }
    }
    // A line crosses at most four of eight cells.
    for (int i = 0; i < 4; ++i) {
        if (is_occupied(ray.voxel, place, place.mip)) {
            if (!take_voxel(ray, place, place.mip, 1.0 - f, goes_on)) return false;
        } else {
            goes_on = step_over(ray, fine_shift);
        }
        if (!goes_on || any(notEqual(cell_of(ray.voxel, fine_shift + 1), cell))) return true;
    }
    return true;
}

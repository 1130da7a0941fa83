// Blends two mips (Crassin et al. 2008, section 4.3). The size of voxel that the ray should see
// (blended_size.glsl) lies between the sides of the voxels of the brick's mip and of the next one. The ray
// walks the coarser cells, and takes the coarse voxel with weight f and the finer ones in the same cell with
// weight 1 - f, so that their mean side is that size. With f = 0 or f = 1 the ray sees one mip alone. Where f
// reaches 1, the next pair of mips begins with f = 0, and nothing changes, because the next mip (or the
// parent's brick) holds the same. A voxel counts as a sheet, which gives its share once. Shares add up, so
// their weighted sum is opaque wherever both mips are.
//
// f has one value for the whole coarse cell, and is linear in the size. A logarithm would differ in its last
// bits between drivers.

bool is_occupied(ivec3 voxel, Place place, int mip) {
    const ivec3 b = place_in(voxel, brick_voxel_shift_of(place) + mip, M_SHIFT - mip);
    const ivec3 c = cell_of(b, BLOCK_SHIFT);
    const int blocks = MIP_BLOCKS_PER_SIDE(mip);
    const uvec2 mask = mask_word(place.brick, first_mask_of(mip) + c.x + blocks * (c.y + blocks * c.z));
    return empty_voxel_shift(mask, b - cell_low(b, BLOCK_SHIFT)) < 0;
}

// Takes what the ray meets in a voxel until something counts: a voxel gives its share once. Moves the ray
// behind the voxel.
bool take_once(inout Ray ray, Place place, int mip, float share, out bool goes_on) {
#if MARKS
    const int shift = brick_voxel_shift_of(place) + mip;
    const ivec3 voxel = cell_of(ray.cell, shift);
    goes_on = true;
    is_counted = false;
    for (int i = 0; i < 10 && goes_on && !is_counted && all(equal(cell_of(ray.cell, shift), voxel)); ++i) {
        if (!take_voxel(ray, place, mip, share, goes_on)) return false;
    }
    if (goes_on && all(equal(cell_of(ray.cell, shift), voxel))) goes_on = step_over(ray, shift);
    return true;
#else
    return take_voxel(ray, place, mip, share, goes_on);
#endif
}

// Takes both mips of the occupied coarse cell around the ray's voxel. `goes_on` and the result are as those
// of take_voxel().
bool take_both(inout Ray ray, Place place, out bool goes_on) {
    const int fine_shift = voxel_shift_of(place);
    const float side = cell_length(fine_shift);
#if PROGRESSIVE
    const bool blends = place.brick_shift == place.tile_shift;  // a brick that stands in is not blended
#else
    const bool blends = true;
#endif
    const float size = blended_size(brick_voxel_shift_of(place), width_at_cell(ray, fine_shift + 1));
    const float f = blends ? clamp(size / side - 1.0, 0.0, 1.0) : 0.0;
    const ivec3 cell = cell_of(ray.cell, fine_shift + 1);
    goes_on = true;
    if (f > 0.0) {
        Ray whole = ray;
        if (!take_once(whole, place, place.mip + 1, f, goes_on)) return false;
        if (f >= 1.0) {
            ray = whole;
            return true;
        }
    }
    // A line crosses at most four of eight cells.
    for (int i = 0; i < 4; ++i) {
        if (is_occupied(ray.cell, place, place.mip)) {
            if (!take_once(ray, place, place.mip, 1.0 - f, goes_on)) return false;
        } else {
            goes_on = step_over(ray, fine_shift);
        }
        if (!goes_on || any(notEqual(cell_of(ray.cell, fine_shift + 1), cell))) return true;
    }
    return true;
}

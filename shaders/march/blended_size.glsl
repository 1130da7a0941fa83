// The size of the voxels that a ray sees if levels of detail are blended. Widths are those of march_view():
// the pixel's cone times the root of N. A tile serves widths from the side of its voxels up to N times that,
// where its parent takes over. In the first half of that range, by ratio, the tile's voxels are shown: they
// are there, and coarser ones are less accurate. In the second half the size grows to that of the parent's
// voxels, so that nothing changes where those take over.
float blended_size(int brick_voxel_shift, float width) {
    const float side = cell_length(brick_voxel_shift);
    precise float size = width * width / (float(TREE_N) * side);
    return max(size, side);
}

// The finer of the two mips whose voxels are just smaller and just larger than the blended size.
int blended_mip(int brick_voxel_shift, float width) {
    const float size = blended_size(brick_voxel_shift, width);
    int mip = 0;
    for (int k = 1; k < BRICK_MIPS; ++k) {
        if (cell_length(brick_voxel_shift + k) <= size) mip = k;
    }
    return mip;
}

// Width of the ray's cone at the point of the aligned cell around its voxel that is nearest to the ray's
// origin. Every call gives exactly the same result: comparisons must not depend on how a compiler contracts
// the sum.
float width_at_cell(Ray ray, int shift) {
#if RAYS_WIDEN
    const vec3 low = corner_of(cell_low(ray.cell, shift)) - ray.origin;
    const vec3 away = max(max(low, -(low + cell_length(shift))), vec3(0.0));
    precise float square = away.x * away.x + away.y * away.y + away.z * away.z;
    precise float width = ray.cone_base + ray.cone_slope * sqrt(square);
    return width;
#else
    return ray.cone_base;
#endif
}

// Does the ray see, around its voxel, this mip of a tile whose voxels have the side 2^brick_voxel_shift, or a
// coarser mip? The answer is the same for a whole voxel of the next mip. A cell is no further away than the
// cells inside it, so a yes for a mip means a yes for all finer mips, and what a ray sees depends on the
// place alone, not on the way there.
bool sees_mip(Ray ray, int brick_voxel_shift, int mip) {
    const float width = width_at_cell(ray, brick_voxel_shift + mip + 1);
    const float side = cell_length(brick_voxel_shift);
    if (mip == 0) return width >= side;
    return blended_size(brick_voxel_shift, width) >= cell_length(brick_voxel_shift + mip);
}

// The size of the voxels that a ray sees, when levels of detail are blended. Widths are those of
// march_view(): the pixel's cone times the root of N, so that a tile serves widths from its own voxels' side
// up to N times that, where its parent takes over. In the first half of that range, by ratio, its own voxels
// are shown: they are there, and coarser ones are less accurate. In the second half the size grows to that of
// the parent's voxels, so that nothing changes where those come.
float blended_size(int brick_voxel_shift, float width) {
    const float side = float(cell_side(brick_voxel_shift));
    precise float size = width * width / (float(TREE_N) * side);
    return max(size, side);
}

// The finer of the two mips around that size.
int blended_mip(int brick_voxel_shift, float width) {
    const float size = blended_size(brick_voxel_shift, width);
    int mip = 0;
    for (int k = 1; k < BRICK_MIPS; ++k) {
        if (float(cell_side(brick_voxel_shift + k)) <= size) mip = k;
    }
    return mip;
}

// Width of the ray's cone where the aligned cell around its voxel is nearest to its origin. Exactly the same
// wherever it is asked: what a ray compares it with must not depend on how a compiler contracts the sum.
float width_at_cell(Ray ray, int shift) {
#if RAYS_WIDEN
    const vec3 low = vec3(cell_low(ray.voxel, shift)) - ray.origin;
    const vec3 away = max(max(low, -(low + float(cell_side(shift)))), vec3(0.0));
    precise float square = away.x * away.x + away.y * away.y + away.z * away.z;
    precise float width = ray.cone_base + ray.cone_slope * sqrt(square);
    return width;
#else
    return ray.cone_base;
#endif
}

// Does the ray see, around its voxel, this mip of a tile with voxels of this size, or a coarser one? A mip
// and the next one are seen by whole voxels of the next one, and a cell is nearer than those that it holds:
// so a ray that sees a mip sees all finer ones too, and what it sees depends on the place alone, not on the
// way there.
bool sees_mip(Ray ray, int brick_voxel_shift, int mip) {
    const float width = width_at_cell(ray, brick_voxel_shift + mip + 1);
    const float side = float(cell_side(brick_voxel_shift));
    if (mip == 0) return width >= side;
    return blended_size(brick_voxel_shift, width) >= float(cell_side(brick_voxel_shift + mip));
}

// The size of the voxels that a ray sees, when levels of detail are blended. Widths are those of march_view(): the pixel's
// cone times the root of N, so that a tile serves widths from its own voxels' side up to N times that, where its parent
// takes over. In the first half of that range, by ratio, its own voxels are shown: they are there, and coarser ones are
// less accurate. In the second half the size grows to that of the parent's voxels, so that nothing changes where those come.
float blended_size(int own_shift, float width) {
    const float side = float(cell_side(own_shift));
    precise float size = width * width / (float(TREE_N) * side);
    return max(size, side);
}

// The finer of the two mips around that size.
int blended_mip(int own_shift, float width) {
    const float size = blended_size(own_shift, width);
    int mip = 0;
    for (int k = 1; k < BRICK_MIPS; ++k) {
        if (float(cell_side(own_shift + k)) <= size) mip = k;
    }
    return mip;
}

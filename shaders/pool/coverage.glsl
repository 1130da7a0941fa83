// The share of a voxel's face that the surface covers, seen along the axis along which it covers most: the
// part that a ray through the voxel meets. A sheet covers the whole face, however thin it is; a wire covers as
// much as it is wide. `marks`: 4^3 finer voxels, bit x + 4 (y + 4 z).
float coverage_of_marks(uvec2 marks) {
    const uint along_z = (marks.x | marks.x >> 16 | marks.y | marks.y >> 16) & 0xFFFFu;
    uvec2 y = marks | marks >> 4;
    y = (y | y >> 8) & 0x000F000Fu;
    uvec2 x = marks | marks >> 1;
    x = (x | x >> 2) & 0x11111111u;
    const int most = max(bitCount(along_z), max(bitCount(y.x) + bitCount(y.y), bitCount(x.x) + bitCount(x.y)));
    return float(most) / 16.0;
}

// Cells: aligned cubes whose side is a power of CELL_BASE, in the finest cells that rays tell apart. The
// exponent is called a shift, because with CELL_BASE 2 it is one.
//
// The finest cells are the voxels of the finest level or, with MARK_SHIFT, parts of them: 2^MARK_SHIFT along
// each axis. Lengths and places are in voxels of the finest level all the same.
//
// Needs the define CELL_BASE: 2 or 3.
#ifndef MARK_SHIFT
#define MARK_SHIFT 0
#endif
#define FINEST_LENGTH (1.0 / float(1 << MARK_SHIFT))
#if CELL_BASE == 3

// The side of a cell. Shifts must be under 20: 3^20 would pass 31 bits. No cell of a tree is larger than 3^13
// (MAX_RESOLUTION_BITS).
int cell_side(int shift) {
    return ((shift & 1) != 0 ? 3 : 1) * ((shift & 2) != 0 ? 9 : 1) * ((shift & 4) != 0 ? 81 : 1) *
           ((shift & 8) != 0 ? 6561 : 1) * ((shift & 16) != 0 ? 43046721 : 1);
}
// Number along each axis of the cell of that size that holds a voxel; also for voxel -1. Integer division is
// slow on most drivers, so a float gives a quotient that is off by at most one, and the remainder corrects
// it.
ivec3 cell_of(ivec3 voxel, int shift) {
    const int side = cell_side(shift);
    const ivec3 near = ivec3(vec3(voxel) * (1.0 / float(side)));
    const ivec3 rest = voxel - near * side;
    return near + ivec3(greaterThanEqual(rest, ivec3(side))) - ivec3(lessThan(rest, ivec3(0)));
}
bool same_cell(ivec3 a, ivec3 b, int shift) { return all(equal(cell_of(a, shift), cell_of(b, shift))); }
// The first voxel of the cell that holds a voxel.
ivec3 cell_low(ivec3 voxel, int shift) { return cell_of(voxel, shift) * cell_side(shift); }
// Place of the cell that holds a voxel in the cell that is `up` powers larger.
ivec3 place_in(ivec3 voxel, int shift, int up) {
    const ivec3 cell = cell_of(voxel, shift);
    return cell - cell_low(cell, up);
}

#else

int cell_side(int shift) { return 1 << shift; }
// Number along each axis of the cell of that size that holds a finest cell.
ivec3 cell_of(ivec3 voxel, int shift) { return voxel >> shift; }
bool same_cell(ivec3 a, ivec3 b, int shift) {
    const ivec3 differ = a ^ b;
    return (differ.x | differ.y | differ.z) >> min(shift, 31) == 0;
}
// The first voxel of the cell that holds a voxel.
ivec3 cell_low(ivec3 voxel, int shift) { return (voxel >> shift) << shift; }
// Place of the cell that holds a voxel in the cell that is `up` powers larger.
ivec3 place_in(ivec3 voxel, int shift, int up) { return (voxel >> shift) & ((1 << up) - 1); }

#endif

// The side of a cell as a length, and the low corner of the finest cells.
float cell_length(int shift) { return FINEST_LENGTH * float(cell_side(shift)); }
vec3 corner_of(ivec3 finest) { return FINEST_LENGTH * vec3(finest); }

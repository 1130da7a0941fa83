// How the producers' shaders give the sides of voxels to voxelize/exact_triangle.glsl: by their log2 in trees of
// powers of two, by lattice units in trees with N = 3.
#if CELL_BASE == 3
#define ANY_VOXEL_SIDE 1
#define FINER(size) ((size) / 4)
#else
#define ANY_VOXEL_SIDE 0
#define FINER(size) ((size) - 2)
#endif

// The mip levels of a brick, and where they lie in the pool (renderer/pool/brick_pool.h): mip k holds the
// brick's region at voxels 2^k times larger, with a border of one of them.
// Needs the defines BRICK_M and BRICK_MIPS (levels beyond mip 0; at most 3).
#define CUBE(n) ((n) * (n) * (n))

// Voxels a side, border not counted.
#define MIP_M(mip) (BRICK_M >> (mip))

// Of each mip: slots along x and y, first layer, texels of a slot's side.
uniform ivec4 pool_levels[BRICK_MIPS + 1];

// First texel of a slot, border included.
ivec3 first_texel(int slot, int mip) {
    const ivec4 level = pool_levels[mip];
    return ivec3(slot % level.x, slot / level.x % level.y, slot / (level.x * level.y)) * level.w + ivec3(0, 0, level.z);
}

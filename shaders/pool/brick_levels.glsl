// The mip levels of a brick, and their places in the pool (renderer/pool/brick_pool.h). Mip k holds the
// brick's region at voxels 2^k times larger, with a border of one such voxel.
// Needs the defines BRICK_M and BRICK_MIPS (levels beyond mip 0; at most 3).
#define CUBE(n) ((n) * (n) * (n))

// Voxels per side of a mip, without the border.
#define MIP_M(mip) (BRICK_M >> (mip))

// Per mip: slots along x and y, first layer, texels per side of a slot.
uniform ivec4 pool_levels[BRICK_MIPS + 1];

// First texel of a mip of a slot, border included.
ivec3 first_texel(int slot, int mip) {
    const ivec4 level = pool_levels[mip];
    return ivec3(slot % level.x, slot / level.x % level.y, slot / (level.x * level.y)) * level.w + ivec3(0, 0, level.z);
}

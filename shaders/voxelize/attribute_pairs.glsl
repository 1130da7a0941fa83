// The list of pairs: a triangle, and an occupied voxel that it touches.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_ATTRIBUTE_PAIRS) restrict buffer AttributePairs {
    uint pair_count;  // number of pairs; those past the end of `pairs` found no room
    uint pair_padding[3];
    // x: voxel x | y << 16; y: voxel z, in the region; z: place of the voxel's sums; w: triangle.
    uvec4 pairs[];
};

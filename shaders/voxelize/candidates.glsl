// Voxels that a masked triangle meets, and whose texels are still to be looked at.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_VOXEL_CANDIDATES) restrict buffer VoxelCandidateBlock {
    uint candidate_count;  // past VOXEL_CANDIDATES some found no room
    uint undecided_count;
    uint padding[2];
    ivec4 candidates[];    // xyz: voxel; w: triangle, and -1 - triangle once it is left to the CPU
};

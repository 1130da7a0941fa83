// Candidates: voxels that a masked triangle meets, and whose texels have not been looked at yet.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_VOXEL_CANDIDATES) restrict buffer VoxelCandidateBlock {
    // Number of candidates; those past the end of `candidates` found no room.
    uint candidate_count;
    uint undecided_count;
    uint padding[2];
    // xyz: voxel; w: triangle, or -1 - triangle once the voxel is left to the CPU.
    ivec4 candidates[];
};

// Queues of triangles that wait for a later pass over the same batch: VOXEL_QUEUE_COUNT counters, then as
// many queues, each with room for a whole batch, so that no queue can overflow.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_VOXEL_QUEUE) restrict buffer VoxelQueue { uint voxel_queue[]; };

// Triangles of a batch at most.
uint queue_room() { return uint(voxel_queue.length()) / VOXEL_QUEUE_COUNT - 1u; }

void enqueue(uint queue, uint triangle) {
    const uint place = atomicAdd(voxel_queue[queue], 1u);
    voxel_queue[VOXEL_QUEUE_COUNT + queue * queue_room() + place] = triangle;
}

uint queued(uint queue, uint place) {
    return voxel_queue[VOXEL_QUEUE_COUNT + queue * queue_room() + place];
}

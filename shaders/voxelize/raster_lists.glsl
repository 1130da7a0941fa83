// The primitives of a batch that may meet a tile, one list a kind (RASTER_*): how many each holds, then the
// numbers of their vertices, then the numbers of their triangles in the bound chunk.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_RASTER_LISTS) restrict buffer RasterLists { uint raster_lists[]; };

// Vertices of a primitive.
uint corners_of(uint kind) { return kind == RASTER_SEGMENTS ? 2u : kind == RASTER_POINTS ? 1u : 3u; }

// Where the vertices of a list begin: each list has room for a whole batch. RASTER_KINDS: where all lists
// end.
uint first_vertex(uint kind) {
    return RASTER_KINDS + kind * 3u * VOXEL_BATCH_TRIANGLES;
}

uint triangle_place(uint kind, uint primitive) {
    return first_vertex(RASTER_KINDS) + kind * VOXEL_BATCH_TRIANGLES + primitive;
}

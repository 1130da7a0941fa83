// The primitives of a batch that may meet a tile, one list per kind (RASTER_*): the lengths of the lists,
// then the numbers of the primitives' vertices, then the numbers of their triangles in the bound chunk.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_RASTER_LISTS) restrict buffer RasterLists { uint raster_lists[]; };

// Number of vertices of a primitive.
uint corners_of(uint kind) { return kind == RASTER_SEGMENTS ? 2u : kind == RASTER_POINTS ? 1u : 3u; }

// Triangles of a batch at most: the buffer holds as many triangles per list, with three vertices each.
uint list_room() { return (uint(raster_lists.length()) / RASTER_KINDS - 1u) / 4u; }

// Place of the first vertex of a list; each list has room for a whole batch. For RASTER_KINDS, the end of all
// lists of vertices.
uint first_vertex(uint kind) {
    return RASTER_KINDS + kind * 3u * list_room();
}

uint triangle_place(uint kind, uint primitive) {
    return first_vertex(RASTER_KINDS) + kind * list_room() + primitive;
}

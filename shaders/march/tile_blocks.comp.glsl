// One workgroup is a block of pixels. It keeps the first few different reports of the block's rays: tiles
// that were missed and then, while there is room, bricks that were used (Crassin et al. 2008, section 5.3).
#include "interop/tile_query.h"

#define BLOCK_PIXELS (TILE_BLOCK_SIDE * TILE_BLOCK_SIDE)

layout(local_size_x = TILE_BLOCK_SIDE, local_size_y = TILE_BLOCK_SIDE) in;

layout(std430, binding = SSBO_TILE_REPORTS) readonly buffer ReportBlock { uint tile_reports[]; };
layout(std430, binding = SSBO_TILE_BLOCKS) writeonly buffer TileBlock { uint tile_blocks[]; };

uniform ivec2 size;  // width and height of the band in pixels

shared uint reports[BLOCK_PIXELS];
// Keys of the pixels whose reports are kept: the pixel's number, or BLOCK_PIXELS more for a used brick. The
// lowest key is chosen first.
shared uint order[TILE_BLOCK_ENTRIES];

uint chosen(uint place) {
    return order[place] == TILE_REPORT_NONE ? TILE_REPORT_NONE : reports[order[place] % uint(BLOCK_PIXELS)];
}

void main() {
    const uint i = gl_LocalInvocationIndex;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint report = TILE_REPORT_NONE;
    if (all(lessThan(pixel, size))) report = tile_reports[pixel.y * size.x + pixel.x];
    reports[i] = report;
    if (i < uint(TILE_BLOCK_ENTRIES)) order[i] = TILE_REPORT_NONE;
    memoryBarrierShared();
    barrier();
    bool is_left = report != TILE_REPORT_NONE;
    for (uint place = 0u; place < uint(TILE_BLOCK_ENTRIES); ++place) {
        if (is_left) atomicMin(order[place], (report & TILE_REPORT_USED) != 0u ? i + uint(BLOCK_PIXELS) : i);
        memoryBarrierShared();
        barrier();
        is_left = is_left && report != chosen(place);
    }
    const uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (i < uint(TILE_BLOCK_ENTRIES)) tile_blocks[block * uint(TILE_BLOCK_ENTRIES) + i] = chosen(i);
}

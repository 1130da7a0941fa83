// The buffers and textures that all passes of rays read and write.
#include "interop/march.h"
#include "interop/pool.h"
#include "interop/tile_query.h"
#include "pool/packed_brick.glsl"

layout(std140, binding = UBO_VIEW) uniform ViewBlock { MarchView view; };
layout(std430, binding = SSBO_RAYS) buffer RayBlock { RayState rays[]; };
layout(std430, binding = SSBO_LISTS) buffer ListBlock { uint lists[]; };
layout(std430, binding = SSBO_QUERIES) buffer QueryBlock {
    MarchCounters counters;
    uint queries[];
};
#if TILE_BLOCKS
layout(std430, binding = SSBO_TILE_REPORTS) writeonly buffer ReportBlock { uint tile_reports[]; };
#else
layout(std430, binding = SSBO_USAGE) buffer UsageBlock { uint usage[]; };
#endif
layout(binding = TEXTURE_NODES) uniform usamplerBuffer nodes;
#if HAS_CONSTANT
layout(binding = TEXTURE_NODE_MEANS) uniform usamplerBuffer node_means;
#endif
#if PACKED
layout(binding = TEXTURE_BRICK_WORDS) uniform usamplerBuffer brick_words;
layout(binding = TEXTURE_BRICK_STARTS) uniform usamplerBuffer brick_starts;
#else
layout(binding = TEXTURE_BRICK_MASKS) uniform usamplerBuffer brick_masks;
layout(binding = TEXTURE_BRICK_COLOR) uniform sampler3D brick_color;
layout(binding = TEXTURE_BRICK_NORMAL) uniform sampler3D brick_normal;
#endif

uniform uint pass_number;
uniform uint query_capacity;      // queries that fit, at most QUERY_CAPACITY
uniform uint usage_query_offset;  // word in usage[] where the query bits start
#if PROGRESSIVE
// The last pass of a frame: ancestors stand in, and no ray may wait.
uniform bool stand_in;
uniform uint entry_count;         // entries in the node pool
#endif

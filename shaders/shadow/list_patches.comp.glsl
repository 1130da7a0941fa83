// Lists micro-patches (Atty et al. 2005, sections 3.2 and 3.3): each texel of the occluder map that holds an
// occluder becomes a micro-patch, with the penumbra extent on the receiver map that it may darken. One thread
// is one row of the map. The first pass counts, the second writes, so that the list has the order of the
// texels in whatever order the threads run: sums of floats depend on the order of the patches.
#include "interop/shadow_map.h"
#include "shadow/window.glsl"

layout(local_size_x = SHADOW_LIST_GROUP) in;
layout(binding = TEXTURE_SHADOW_OCCLUDERS) uniform sampler2D occluders;
layout(binding = TEXTURE_SHADOW_PYRAMID) uniform sampler2D furthest_receivers;
layout(std430, binding = SSBO_SHADOW_COUNTS) buffer Counts { uint counts[]; };
layout(std430, binding = SSBO_SHADOW_PATCHES) buffer Patches { MicroPatch patches[]; };
uniform vec4 occluder_window;
uniform vec4 receiver_window;
uniform vec2 light_half;
uniform int receiver_size;

bool is_occluder(float w) {
    return w > 0.0 && w < SHADOW_NONE;
}

// The first texel of the receiver map, and the one past the last, where a receiver that is no further than
// inverse depth `furthest` could see the patch before the light.
ivec4 texels_before(vec4 edges, float w, float furthest) {
    if (w <= furthest) return ivec4(0);
    const vec2 reach = light_half * (w - furthest);
    const float size = float(receiver_size);
    const vec2 low = texels_at(receiver_window, edges.xy - reach, size) - 0.5 - SHADOW_EXTENT_SLACK;
    const vec2 high = texels_at(receiver_window, edges.zw + reach, size) - 0.5 + SHADOW_EXTENT_SLACK;
    // Clamped as floats, because numbers far outside do not fit an int.
    return ivec4(clamp(ceil(low), 0.0, size), clamp(floor(high) + 1.0, 0.0, size));
}

bool is_empty(ivec4 extent) {
    return any(lessThanEqual(extent.zw, extent.xy));
}

// The least inverse depth of the receivers in the extent, from at most four texels of the pyramid.
float furthest_in(ivec4 extent) {
    const ivec2 span = extent.zw - extent.xy;
    const int level = findMSB(max(span.x, span.y) - 1) + 1;  // its texels are no narrower than the extent
    const ivec2 low = extent.xy >> level;
    const ivec2 high = (extent.zw - 1) >> level;
    return min(min(texelFetch(furthest_receivers, low, level).x, texelFetch(furthest_receivers, high, level).x),
               min(texelFetch(furthest_receivers, ivec2(low.x, high.y), level).x,
                   texelFetch(furthest_receivers, ivec2(high.x, low.y), level).x));
}

// Atty et al. take one depth for the virtual plane of the map. The depth of the furthest receiver leaves no
// receiver out. Nor does the depth of the furthest receiver within the extent that results, which is often
// much nearer.
ivec4 penumbra_extent(vec4 edges, float w) {
    const int top = textureQueryLevels(furthest_receivers) - 1;
    ivec4 extent = texels_before(edges, w, texelFetch(furthest_receivers, ivec2(0), top).x);
    if (!is_empty(extent)) extent = texels_before(edges, w, furthest_in(extent));
    if (!is_empty(extent)) extent = texels_before(edges, w, furthest_in(extent));
    return is_empty(extent) ? ivec4(0) : extent;
}

void count_fragments(uint area) {
    const uint before = atomicAdd(counts[SHADOW_COUNT_FRAGMENTS], area);
    if (before + area < before) atomicAdd(counts[SHADOW_COUNT_FRAGMENTS + 1], 1u);
}

void main() {
    const int row = int(gl_GlobalInvocationID.x);
    const ivec2 size = textureSize(occluders, 0);
    if (row >= size.y) return;
#if LIST_WRITES
    uint next = 0u;
    for (int before = 0; before < row; ++before)
        next += counts[SHADOW_COUNT_ROWS + before];
#else
    uint count = 0u;
#endif
    for (int column = 0; column < size.x; ++column) {
        const float w = texelFetch(occluders, ivec2(column, row), 0).x;
        if (!is_occluder(w)) continue;
#if LIST_WRITES
        const vec4 edges = vec4(tangents_at(occluder_window, vec2(column, row), float(size.x)),
                                tangents_at(occluder_window, vec2(column, row) + 1.0, float(size.x)));
        const uvec4 extent = uvec4(penumbra_extent(edges, w));
        patches[next].texel = uint(column) | uint(row) << 16;
        patches[next].inverse_depth = w;
        patches[next].extent_low = extent.x | extent.y << 16;
        patches[next].extent_high = extent.z | extent.w << 16;
        ++next;
        count_fragments((extent.z - extent.x) * (extent.w - extent.y));
#else
        ++count;
#endif
    }
#if !LIST_WRITES
    counts[SHADOW_COUNT_ROWS + row] = count;
    atomicAdd(counts[SHADOW_COUNT_PATCHES], count);
#endif
}

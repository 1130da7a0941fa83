// Sets the bits of the slices that a primitive meets in a column of voxels (Forest et al. 2009, section 2.2).
// The logic operation OR gathers the bits in targets of RASTER_TARGET_SLICES slices each.
#define VARYING in
#include "interop/surface.h"
#include "interop/voxelize.h"
#include "voxelize/slice_inputs.glsl"
#if MASKED
#include "voxelize/surface_color.glsl"
#include "voxelize/raster_lists.glsl"
#include "voxelize/surface.glsl"
#endif

layout(location = 0) out uvec4 slices[TARGETS];

uniform float tile_middle;
uniform float half_pixel;
// In voxels: more than the rounding of a plane or a side inside the tile.
uniform float slack;
uniform uint kind;    // RASTER_*: the list that is drawn

#if COVER
// Whether the pixel (its centre, if half_pixel is 0) touches the primitive in the projection along this
// direction.
bool touches(vec2 place) {
    const vec3 p = vec3(place, 1.0);
    const float nearest = min(min(dot(slice_side_a, p), dot(slice_side_b, p)), dot(slice_side_c, p));
    const float reach = half_pixel + slack;
    return nearest >= -reach && all(greaterThanEqual(place, slice_box.xy - reach)) &&
           all(lessThanEqual(place, slice_box.zw + reach));
}
#endif

// First and last slice that the primitive meets; empty if the last comes before the first.
ivec2 slice_range(vec2 place) {
    const float depth = dot(slice_plane, vec3(place, 1.0));
#if COVER
    if (half_pixel > 0.0) {
        const float reach = half_pixel * (abs(slice_plane.x) + abs(slice_plane.y)) + slack;
        const float low = max(depth - reach, slice_limits.x - slack);
        const float high = min(depth + reach, slice_limits.y + slack);
        // Voxels are closed, so a primitive between two slices touches both.
        return ivec2(clamp(vec2(ceil(low) - 1.0, floor(high)), -1.0, float(TARGETS * RASTER_TARGET_SLICES)));
    }
#endif
    return ivec2(floor(clamp(depth, slice_limits.x, slice_limits.y)));
}

#if COVER
// Bits 0 to count - 1 of a word, for counts from 0 to 32.
uvec4 low_bits(ivec4 count) {
    return mix((uvec4(1u) << uvec4(count & 31)) - 1u, uvec4(0xFFFFFFFFu), equal(count, ivec4(32)));
}

// The bits of a range of slices in a target.
uvec4 slice_bits(ivec2 range, int target) {
    const ivec4 first_slice = target * RASTER_TARGET_SLICES + ivec4(0, 32, 64, 96);
    const uvec4 before = low_bits(clamp(range.x - first_slice, 0, 32));
    return low_bits(clamp(range.y + 1 - first_slice, 0, 32)) & ~before;
}
#else
// The bit of one slice in a target; 0 if the range is empty.
uvec4 slice_bits(ivec2 range, int target) {
    const uint bit = range.x <= range.y ? 1u << uint(range.x & 31) : 0u;
    return mix(uvec4(0u), uvec4(bit), equal(ivec4(range.x >> 5), 4 * target + ivec4(0, 1, 2, 3)));
}
#endif

#if MASKED
// Whether the alpha mask leaves surface under the pixel's centre, or at the primitive's point nearest to it.
bool is_shown(vec2 place) {
    const uint triangle = raster_lists[triangle_place(kind, slice_primitive)];
    const SurfaceMaterial material = surface_materials[surface_triangles[triangle].material];
    if (!is_masked(material)) return true;
    const uint corners = corners_of(kind);
    const uint vertex = first_vertex(kind) + slice_primitive * corners;
    SurfacePoint point;
    point.vertices = uvec3(raster_lists[vertex], raster_lists[vertex + min(1u, corners - 1u)],
                           raster_lists[vertex + corners - 1u]);
    const float b = dot(slice_weight_b, vec3(place, 1.0)), c = dot(slice_weight_c, vec3(place, 1.0));
    const vec3 weights = max(vec3(1.0 - b - c, b, c), 0.0);
    point.weights = weights / (weights.x + weights.y + weights.z);
    return alpha_at(point, material) * ALPHA_SLACK >= material.alpha_cutoff;
}
#endif

void main() {
    const vec2 place = gl_FragCoord.xy - tile_middle;
    ivec2 range = slice_range(place);
#if COVER
    if (!touches(place)) range = ivec2(0, -1);
#endif
#if MASKED
    if (!is_shown(place)) range = ivec2(0, -1);
#endif
    // Fragments need not be discarded: a word without bits changes nothing. Depths past the ends of the tile
    // set no bits.
    for (int target = 0; target < TARGETS; ++target) slices[target] = slice_bits(range, target);
}

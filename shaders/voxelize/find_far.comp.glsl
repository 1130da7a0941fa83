// One thread is one triangle. The pass counts the triangles that reach the root cube from further away than
// SurfaceChunk::positions can hold; deform.comp.glsl has moved such vertices to just past that range.
#include "interop/deform.h"
#include "interop/grid.h"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_DEFORM_FRAME) restrict buffer FrameBlock { DeformHeader header; };

uniform uint count;

void main() {
    const uint thread = thread_index();
    if (thread >= count) return;
    const uvec3 corners = surface_triangles[thread].vertices;
    const ivec3 a = surface_position(corners.x);
    const ivec3 b = surface_position(corners.y);
    const ivec3 c = surface_position(corners.z);
    const ivec3 low = min(min(a, b), c);
    const ivec3 high = max(max(a, b), c);
    const int side = 1 << LATTICE_BITS;
    if (any(lessThan(high, ivec3(0))) || any(greaterThan(low, ivec3(side)))) return;
    if (any(lessThan(low, ivec3(-side))) || any(greaterThan(high, ivec3(2 * side)))) {
        atomicAdd(header.far_triangles, 1u);
    }
}

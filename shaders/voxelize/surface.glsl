// One chunk of the surface, as voxelizer/surface/surface.h uploads it.
#include "interop/surface.h"

layout(std430, binding = SSBO_SURFACE_POSITIONS) restrict readonly buffer SurfacePositions {
    int surface_positions[];
};
layout(std430, binding = SSBO_SURFACE_TRIANGLES) restrict readonly buffer SurfaceTriangles {
    SurfaceTriangle surface_triangles[];
};
layout(std430, binding = SSBO_SURFACE_MATERIALS) restrict readonly buffer SurfaceMaterials {
    SurfaceMaterial surface_materials[];
};

// Position of a vertex, lattice units.
ivec3 surface_position(uint vertex) {
    return ivec3(surface_positions[3u * vertex], surface_positions[3u * vertex + 1u],
                 surface_positions[3u * vertex + 2u]);
}

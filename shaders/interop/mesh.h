// Meshes that are rasterized in the picture of voxels, and proxies that bound what is shown of them.
#ifndef CAIRN_INTEROP_MESH_H
#define CAIRN_INTEROP_MESH_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

// Beside the surface's bindings, and UBO_VIEW.
#define UBO_MESH_VIEW 1
#define SSBO_MESH_TRIANGLES 5    // MeshTriangle: a batch of triangles, as this view sees them
// R32F per pixel: distance of the nearest mesh, MESH_MISS where there is none.
#define TEXTURE_MESH_NEAREST 8
#define TEXTURE_MESH_SURFACE 9   // RGBA32UI per pixel: what is there (shaders/mesh/mesh_surface.glsl)
// RG32F per pixel: distance of the proxy's first face, minus that of its last.
#define TEXTURE_PROXY_SPAN 10
#define TEXTURE_PROXY_FACES 11   // R32F per pixel: fronts less backs

#define MESH_BATCH_TRIANGLES 262144  // triangles per draw call
#define MESH_STRIP_PIXELS 4194304    // pixels of a picture that are drawn at once, in whole rows
#define MESH_MISS 1e30               // the distance of what is not there
#define MESH_NEAREST_PART 9.5367431640625e-7  // how near the eye a mesh may come, in sides of the mesh
// Voxels whose centres lie lower over a mesh are part of its surface and cast no shadow on it, in sides of a
// voxel. The centre of a voxel that touches a triangle lies at most half a diagonal (0.87) from the triangle's
// plane; a little further, where the surface bends.
#define MESH_SELF_SHADOW_HEIGHT 1.125

#ifdef __cplusplus
namespace cairn::interop {
#endif

// How a mesh stands to the rays of a MarchView. A point of the lattice, p, lies at p * lattice_unit + origin
// from MarchView.eye, in its units; from there, the rows give what its picture and its depth are in
// homogeneous coordinates: x to the right, y downwards, both -1 to 1 over the picture, each times w = along +
// skipped.
struct MeshView {
    dvec3 origin;
    double lattice_unit;
    dvec3 across;          // to x
    double padding;
    dvec3 down;            // to y
    double nearest;        // the least w that is drawn
    dvec3 along;           // to the distance along MarchView.forward
    double skipped;        // MarchView.skipped
};

// A triangle, from MarchView.eye and in the units of MarchView.
struct MeshTriangle {
    vec3 normal;           // unit, of its front; 0 without area
    float height;          // the normal's product with the triangle's points
    vec3 corner;           // first vertex
    float nearest;         // the least distance of a vertex along MarchView.forward
    vec3 second;           // its product with (point - corner) is the second vertex's weight
    float furthest;        // the greatest distance of a vertex along MarchView.forward
    vec3 third;            // its product with (point - corner) is the third vertex's weight
    float padding;
};

#ifdef __cplusplus
static_assert(sizeof(MeshView) == 128, "GLSL sees another layout");
static_assert(offsetof(MeshView, down) == 64, "GLSL sees another layout");
static_assert(sizeof(MeshTriangle) == 64, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

// Meshes that are rasterized into the picture of voxels, and proxies: meshes that bound the voxels that are
// shown.
#ifndef CAIRN_INTEROP_MESH_H
#define CAIRN_INTEROP_MESH_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

// Beside the surface's bindings, and UBO_VIEW.
#define UBO_MESH_VIEW 1
#define SSBO_MESH_TRIANGLES 5    // MeshTriangle: a batch of triangles, as this view sees them
// R32F per pixel: distance of the nearest mesh, or MESH_MISS.
#define TEXTURE_MESH_NEAREST 8
#define TEXTURE_MESH_SURFACE 9   // RGBA32UI per pixel: colour and normals (shaders/mesh/mesh_surface.glsl)
// RG32F per pixel. r: distance of the proxy's first face; g: minus the distance of its last face.
#define TEXTURE_PROXY_SPAN 10
#define TEXTURE_PROXY_FACES 11   // R32F per pixel: number of front faces less that of back faces

#define MESH_MISS 1e30               // distance of a pixel without a mesh
#define MESH_NEAREST_PART 9.5367431640625e-7  // 2^-20: least distance that is drawn, in sides of the mesh
// Voxels whose centres lie lower over a mesh are part of its surface and cast no shadow on it, in sides of a
// voxel, or of a mark. The centre of a voxel that touches a triangle lies at most half a diagonal (0.87) from the
// triangle's plane; a little further, where the surface bends.
#define MESH_SELF_SHADOW_HEIGHT 1.125

#ifdef __cplusplus
namespace cairn::interop {
#endif

// The place of a mesh relative to the rays of a MarchView. A point p of the lattice lies at p * lattice_unit
// + origin from MarchView.eye, in units of the MarchView. The scalar products of that vector with `across`,
// `down` and `along` are the homogeneous coordinates of its picture: x to the right and y downwards, both -1
// to 1 over the picture and multiplied by w = along + skipped.
struct MeshView {
    dvec3 origin;
    double lattice_unit;
    dvec3 across;          // row of the matrix that gives x * w
    double moved_across;   // by how much the picture is moved to the right, in halves of its width
    dvec3 down;            // row of the matrix that gives y * w
    double nearest;        // least w that is drawn
    dvec3 along;           // row that gives the distance along MarchView.forward
    double skipped;        // MarchView.skipped
    double moved_down;     // by how much the picture is moved downwards, in halves of its height
    double padding1, padding2, padding3;
};

// A triangle, relative to MarchView.eye and in units of the MarchView.
struct MeshTriangle {
    vec3 normal;           // unit normal of the front; 0 if the triangle has no area
    float height;          // scalar product of the normal and a point of the triangle
    vec3 corner;           // first vertex
    float nearest;         // least distance of a vertex along MarchView.forward
    // Scalar product with (point - corner): weight of the second vertex.
    vec3 second;
    float furthest;        // greatest distance of a vertex along MarchView.forward
    // Scalar product with (point - corner): weight of the third vertex.
    vec3 third;
    float padding;
};

#ifdef __cplusplus
static_assert(sizeof(MeshView) == 160, "GLSL sees another layout");
static_assert(offsetof(MeshView, down) == 64, "GLSL sees another layout");
static_assert(sizeof(MeshTriangle) == 64, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

// Data that moves a surface (shaders/voxelize/deform.comp.glsl), beside its positions and attributes.
#ifndef CAIRN_INTEROP_DEFORM_H
#define CAIRN_INTEROP_DEFORM_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

// A uvec4 per vertex. xyz: bits of the position's floats at rest, in mesh space; w: number of its DeformItem.
#define SSBO_DEFORM_VERTICES 1
#define SSBO_DEFORM_VECTORS 3     // float[3] each: normals at rest, and displacements of morph targets
#define SSBO_DEFORM_INFLUENCES 4  // DeformInfluences
#define SSBO_DEFORM_ITEMS 5       // DeformItem
#define SSBO_DEFORM_MATRICES 6    // double[12] each: four columns of three
#define SSBO_DEFORM_FRAME 7       // DeformHeader, then DeformTarget

#define DEFORM_NONE 4294967295u
// Greatest number of morph targets and influences of a vertex, which are turns of a loop. Past it, the CPU
// deforms the surface.
#define DEFORM_TURNS 16384

#ifdef __cplusplus
namespace cairn::interop {
#endif

// A run of a chunk's vertices that move alike: one primitive at one place.
struct DeformItem {
    uint first_vertex;     // number in the chunk
    // Number in SSBO_DEFORM_MATRICES: of world_from_mesh. The next matrix is normal_from_mesh, in its first
    // nine numbers.
    uint matrix;
    // Number of the matrix of the skin's first joint; DEFORM_NONE: no skin.
    uint first_joint;
    uint first_influence;  // number of the first DeformInfluences of first_vertex
    uint set_count;        // DeformInfluences per vertex
    // Number in SSBO_DEFORM_VECTORS of the normal of first_vertex; DEFORM_NONE: no normals.
    uint first_normal;
    uint first_target;     // number of the first DeformTarget
    uint target_count;
};

// Four influences of a skin on a vertex. Influences that count come first; a weight of 0 ends them.
struct DeformInfluences {
    uint joints[2];        // numbers of four joints, 16 bits each
    float weights[4];
};

struct DeformTarget {
    // Number in SSBO_DEFORM_VECTORS of the displacement of the item's first_vertex; DEFORM_NONE: the target
    // moves no positions.
    uint first_position;
    // Number of the displacement of that vertex's normal; DEFORM_NONE: the target moves no normals.
    uint first_normal;
    float weight;          // weight in this frame; finite
    uint padding;
};

struct DeformHeader {
    double origin[3];      // Grid::origin
    double scale;          // Grid::lattice_scale
    uint stray;            // number of vertices that SurfaceChunk::positions cannot hold
    uint lost;             // number of vertices past LATTICE_WORLD_LIMIT, or not finite
    // Number of triangles with a stray vertex that may reach the root cube.
    uint far_triangles;
    uint padding;
};

#ifdef __cplusplus
static_assert(sizeof(DeformItem) == 32, "GLSL sees another layout");
static_assert(sizeof(DeformInfluences) == 24, "GLSL sees another layout");
static_assert(sizeof(DeformTarget) == 16, "GLSL sees another layout");
static_assert(sizeof(DeformHeader) == 48, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

// What moves a surface (shaders/voxelize/deform.comp.glsl), beside its positions and attributes.
#ifndef CAIRN_INTEROP_DEFORM_H
#define CAIRN_INTEROP_DEFORM_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

// uvec4 per vertex. xyz: bits of its floats at rest, in mesh space; w: its DeformItem.
#define SSBO_DEFORM_VERTICES 1
#define SSBO_DEFORM_VECTORS 3     // float[3] each: normals at rest, and displacements of morph targets
#define SSBO_DEFORM_INFLUENCES 4  // DeformInfluences
#define SSBO_DEFORM_ITEMS 5       // DeformItem
#define SSBO_DEFORM_MATRICES 6    // double[12] each: four columns of three
#define SSBO_DEFORM_FRAME 7       // DeformHeader, then DeformTarget

#define DEFORM_GROUP 64
#define DEFORM_NONE 4294967295u
#define DEFORM_TURNS 16384  // morph targets and influences of a vertex: loop turns. Past it, the CPU deforms.

#ifdef __cplusplus
namespace cairn::interop {
#endif

// A run of a chunk's vertices that move alike: one primitive at one place.
struct DeformItem {
    uint first_vertex;     // in the chunk
    // In SSBO_DEFORM_MATRICES: world_from_mesh, then normal_from_mesh in its first nine numbers.
    uint matrix;
    uint first_joint;      // the matrix of the skin's first joint; DEFORM_NONE: no skin
    uint first_influence;  // of first_vertex
    uint set_count;        // DeformInfluences per vertex
    uint first_normal;     // of first_vertex, in SSBO_DEFORM_VECTORS; DEFORM_NONE: no normals
    uint first_target;     // in SSBO_DEFORM_FRAME
    uint target_count;
};

// Four influences of a skin on a vertex. A vertex has those that count first; the first weight of 0 ends
// them.
struct DeformInfluences {
    uint joints[2];        // 16 bits each
    float weights[4];
};

struct DeformTarget {
    // Displacement of the item's first_vertex, in SSBO_DEFORM_VECTORS; DEFORM_NONE: moves none.
    uint first_position;
    uint first_normal;     // displacement of its normal, likewise
    float weight;          // of this frame; finite
    uint padding;
};

struct DeformHeader {
    double origin[3];      // of the grid
    double scale;          // Grid::lattice_scale
    uint stray;            // vertices that SurfaceChunk::positions cannot hold
    uint lost;             // vertices past LATTICE_WORLD_LIMIT, or not finite
    uint far_triangles;    // that have a stray vertex and may reach the root cube
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

// Structures in buffers that C++ writes and GLSL reads. No vec3: std140 and std430 pad it, C++ does not.
#ifndef CAIRN_INTEROP_TYPES_H
#define CAIRN_INTEROP_TYPES_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace cairn::interop {
using glm::dvec4;
using glm::ivec4;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
using uint = glm::uint;
#endif

// Vertices are numbers into the chunk's positions and attributes. A segment is (a, b, b), a point (a, a, a).
struct SurfaceTriangle {
    uvec4 vertices_material;  // xyz: vertices; w: material
};

struct SurfaceAttributes {
    uint normal;    // octahedral, snorm 16 + 16; 0 = none: use the triangle's own
    uint color;     // RGBA8, linear, 255 = 1
    vec2 texcoord;  // in the texture's space (after KHR_texture_transform)
};

struct SurfaceMaterial {
    vec4 base_color;      // linear
    uint texel_offset;    // first texel in SSBO_SURFACE_TEXELS
    uint width;           // 0 = no texture
    uint height;
    uint flags;           // MATERIAL_*
    float alpha_cutoff;
    uint alpha_threshold;  // passes: texel alpha * vertex alpha * 256 >= this, both alphas 0 to 255
    uint passing_offset;   // masked and textured: first number in SSBO_SURFACE_TEXELS of (width + 1) * (height + 1):
                           // number (x, y) counts the passing texels left of x and above y, for vertex alpha 255
    float padding2;
};

// A run of a chunk's vertices that move alike: one primitive at one place.
struct DeformItem {
    uint first_vertex;     // in the chunk
    uint matrix;           // in SSBO_DEFORM_MATRICES: world_from_mesh, then normal_from_mesh in its first nine numbers
    uint first_joint;      // the matrix of the skin's first joint; DEFORM_NONE: no skin
    uint first_influence;  // of first_vertex
    uint set_count;        // DeformInfluences a vertex
    uint first_normal;     // of first_vertex, in SSBO_DEFORM_VECTORS; DEFORM_NONE: no normals
    uint first_target;     // in SSBO_DEFORM_FRAME
    uint target_count;
};

// Four influences of a skin on a vertex. A vertex has those that count first; the first weight of 0 ends them.
struct DeformInfluences {
    uint joints[2];        // 16 bits each
    float weights[4];
};

struct DeformTarget {
    uint first_position;   // displacement of the item's first_vertex, in SSBO_DEFORM_VECTORS; DEFORM_NONE: moves none
    uint first_normal;     // the same for normals
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

// One tile in the node pool (Crassin et al. 2008, section 4.2). A tile that is empty has no entry: its bit in the
// parent's mask is 0. With N = 8 a bit stands for a group of 2^3 children, bit x + 4 (y + 4 z), and a child that is empty
// in a group that is not is told by its own entry.
struct NodeEntry {
    uvec2 child_mask;  // bit x + N (y + N z): child (x, y, z) is not empty
    uint children;     // number of the first child's entry; 0 = leaf
    uint brick;        // NODE_SLOT: slot + 1, 0 = no brick; the other bits are flags (config.h)
};

// A tile whose brick is being produced, and a triangle that may touch it.
struct BrickTile {
    ivec4 low_size;    // xyz: low corner, in voxels of the tile's level, without the border; w: log2 of a voxel's side
                       // in lattice units; the side itself where N = 3
    ivec4 slot;        // x: slot; the rest is not used
};
// A tile of the fractal (renderer/produce/fractal_content.h) whose brick is being produced.
struct FractalTile {
    ivec4 slot_texel;  // xyz: first texel of the slot in the pool's textures (border included); w: slot
    uvec4 neighbours;  // x: bit x + 3 (y + 3 z): the tile (x, y, z) - 1 away is not empty
};
struct BrickPair {
    uint triangle;     // local to the bound surface chunk
    uint tile_mip;     // in the batch | mip << 16
    uint rows;         // of the mip: first y | count of y << 8 | first z << 16 | count of z << 24, border included
};

// All lengths in voxels of the finest level, positions from the root cube's low corner. Where rays go through windows,
// `eye` and `light` stand in MarchWindow instead.
struct MarchView {
    vec4 eye;              // moved forward to near the root cube, for the precision of floats; w: width of a pixel's
                           // cone at distance 1
    vec4 forward;          // unit; w: rays start this far from the eye, in the plane across it that `eye` lies in
    vec4 right;            // half the image's width at distance 1
    vec4 up;               // half the image's height at distance 1
    vec4 light;            // xyz: position, or unit direction to the light; w: 1 = positional
    vec4 light_color;      // w: ambient
    vec4 background;       // w: width of shadow rays, in widths of their pixels' cones
    vec4 surface_color;    // base colour everywhere, when the pool holds none
    vec4 shadow_across;    // ShadowEnds, when there are any
    vec4 shadow_down;
    ivec4 size_shadow;     // xy: pixels of the picture; z: 1 = trace shadow rays; w: 1 = there are ShadowEnds
    vec4 light_u;          // area lights: half axis, from the light's middle; w: radius of a sphere
    vec4 light_v;          // the other half axis; w: 1 - cosine of a directional light's angle
    ivec4 area_light;      // x: shadow rays a pixel; y: LIGHT_*; z: 1 = they go to samples of the light, 0 = one
                           // to its middle; w: 1 = they are cones
    ivec4 band;            // x: first row, y: rows of the band that is marched; buffers hold the band alone; z: SHOW_*;
                           // w: a pixel of the background
};

// 2^3 tiles of one level, with the eye among them. Lengths in its own voxels, positions from its low corner.
struct MarchWindow {
    vec4 eye;
    vec4 light;            // as MarchView.light
    ivec4 shift_level;     // xyz: the low corner in the next, coarser window; w: level of the tiles
    uvec4 tiles[2];        // entry of tile x + 2 (y + 2 z), or WINDOW_*
};

// What rays through a volume need to know. Lengths in voxels of the finest level.
struct VolumeView {
    float voxel_size;     // world units
    float full_gradient;  // densities a voxel: a gradient so steep is lit as a surface, one of 0 as fog; 0: all is fog
    float shadow_start;   // a shadow ray starts so many voxels of the level that is seen from the point
    float padding;
};

// A ray between two passes. Primary: what it has gathered. Shadow: depth and color stay, `weight` becomes visibility.
struct RayState {
    vec4 color;            // rgb: gathered, premultiplied; a: transmittance
    vec4 normal_depth;     // xyz: gathered normal; w: distance of the voxel that weighs most
    uvec4 voxel_t_weight;  // xy: packed voxel; z, w: bits of floats: distance; the greatest weight, or the light's visibility
};

// Shadow rays of a pixel to a light with an extent, while one of them waits.
struct ShadowSum {
    uint ray;              // the one that waits
    float visible;         // sum over those before it
};
// Cones likewise, and what the one that waits has been covered by.
struct ShadowConeSum {
    uint ray;
    float visible;
    float front;
    float back;
};

// A block of PIXEL_BLOCK_SIDE^2 pixels, and where its rays may meet anything.
struct BlockStart {
    uint block;            // number in the band, row after row
    float near;            // distances from the eye
    float far;
};

// How a mesh stands to the rays of a MarchView. A point of the lattice, p, lies at p * place.w + place.xyz from
// MarchView.eye, in its units; from there, the rows give what its picture and its depth are in homogeneous coordinates:
// x to the right, y downwards, both -1 to 1 over the picture, each times w = along + along.w.
struct MeshView {
    dvec4 place;
    dvec4 across;          // xyz: to x
    dvec4 down;            // xyz: to y; w: the least w that is drawn
    dvec4 along;           // xyz: to the distance along MarchView.forward; w: MarchView.forward.w
};

// A triangle, from MarchView.eye and in the units of MarchView.
struct MeshTriangle {
    vec4 plane;            // xyz: unit normal of its front, 0 without area; w: its product with the triangle's points
    vec4 corner;           // xyz: first vertex; w: the least distance of a vertex along MarchView.forward
    vec4 second;           // xyz: its product with (point - corner) is the second vertex's weight; w: the greatest distance
    vec4 third;            // xyz: the same for the third vertex
};

struct MarchCounters {
    uint waiting_primary;
    uint waiting_shadow;
    uint queries;
    uint paused;           // rays that used up the pass's turns and go on in the next
    uint stood_in;         // tiles that were missing and that no ray waited for
    uint launched;         // rays that a proxy let run
};

// A texel of the occluder map as a small rectangle parallel to the light (Atty et al. 2005, section 3.2), and the texels of
// the soft shadow map that it may darken. Words of two 16-bit halves: x | y << 16.
struct MicroPatch {
    uint texel;            // of the occluder map
    float inverse_depth;   // 1 / distance from the light's plane
    uint extent_low;       // first texel
    uint extent_high;      // past the last texel; equal to the first: it darkens none
};

#ifdef __cplusplus
static_assert(sizeof(MicroPatch) == 16, "GLSL sees another layout");
static_assert(sizeof(NodeEntry) == 16, "GLSL sees another layout");
static_assert(sizeof(BrickTile) == 32, "GLSL sees another layout");
static_assert(sizeof(FractalTile) == 32, "GLSL sees another layout");
static_assert(sizeof(BrickPair) == 12, "GLSL sees another layout");
static_assert(sizeof(MarchView) == 240, "GLSL sees another layout");
static_assert(sizeof(MarchWindow) == 80, "GLSL sees another layout");
static_assert(sizeof(VolumeView) == 16, "GLSL sees another layout");
static_assert(sizeof(RayState) == 48, "GLSL sees another layout");
static_assert(sizeof(ShadowSum) == 8, "GLSL sees another layout");
static_assert(sizeof(ShadowConeSum) == 16, "GLSL sees another layout");
static_assert(sizeof(MarchCounters) == 24, "GLSL sees another layout");
static_assert(sizeof(BlockStart) == 12, "GLSL sees another layout");
static_assert(sizeof(MeshView) == 128, "GLSL sees another layout");
static_assert(sizeof(MeshTriangle) == 64, "GLSL sees another layout");
static_assert(sizeof(DeformItem) == 32, "GLSL sees another layout");
static_assert(sizeof(DeformInfluences) == 24, "GLSL sees another layout");
static_assert(sizeof(DeformTarget) == 16, "GLSL sees another layout");
static_assert(sizeof(DeformHeader) == 48, "GLSL sees another layout");
static_assert(sizeof(SurfaceTriangle) == 16, "GLSL sees another layout");
static_assert(sizeof(SurfaceAttributes) == 16, "GLSL sees another layout");
static_assert(sizeof(SurfaceMaterial) == 48, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

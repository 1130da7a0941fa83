// Read by C++ and GLSL 4.50: comments, guards and numeric #defines only.
#ifndef CAIRN_INTEROP_CONFIG_H
#define CAIRN_INTEROP_CONFIG_H

// Vertices are rounded once to this lattice; the root cube of a grid is 2^LATTICE_BITS units a side.
#define LATTICE_BITS 24
// World coordinates further away than this many lattice units are an error.
#define LATTICE_WORLD_LIMIT 1099511627776.0

// A surface is cut in chunks of at most this many triangles, so that each of its buffers stays under the smallest
// shader-storage limit in use (128 MiB). A triangle's global number is chunk * SURFACE_CHUNK_TRIANGLES + local.
#define SURFACE_CHUNK_TRIANGLES 2097152

// The voxelizer marks so many triangles in one pass: bounds its queues and the time of a dispatch.
#define VOXEL_BATCH_TRIANGLES 262144
#define VOXEL_CANDIDATES 1048576  // voxels of masked triangles at a time
// Triangles of at most VOXEL_SMALL_ROWS rows are marked by the thread that meets them. Others wait in queues, and are shared
// by more threads the more rows they have, so that each has about VOXEL_THREAD_ROWS.
#define VOXEL_SMALL_ROWS 64
#define VOXEL_THREAD_ROWS 64
#define VOXEL_GROUP 64
// The first of VOXEL_SHARED_CLASSES queues: a triangle of class c is shared by VOXEL_SHARED_LEAST * VOXEL_SHARED_FACTOR^c
// threads, of the last class by as many as the region's largest may need.
#define VOXEL_QUEUE_SHARED 0
#define VOXEL_SHARED_CLASSES 6
#define VOXEL_SHARED_LEAST 8
#define VOXEL_SHARED_FACTOR 4
#define VOXEL_QUEUE_MASKED_SMALL 6  // those that a mask cuts, with a box of at most so many voxels
#define VOXEL_MASKED_SMALL_BOX 4096
#define VOXEL_QUEUE_MASKED_LARGE 7
#define VOXEL_QUEUE_DOUBT 8  // those of few rows that the float filter could not decide
#define VOXEL_QUEUE_COUNT 9
// llvmpipe ends every loop of an invocation once they have turned 65535 times in all, and says nothing. Two limits keep
// well under it: voxels along an axis of a region, and steps to decide about one voxel of a masked triangle.
#define VOXEL_REGION_SIDE 16384
#define MASK_STEPS 1024
#define MASK_EMPTY 0
#define MASK_SURFACE 1
#define MASK_UNDECIDED 2      // left to the CPU: too many steps, or vertex alphas under 1

// Attributes of voxels (voxelizer/methods/voxel_attributes.h).
#define VOXEL_RANK_WORDS 8
#define ATTRIBUTE_PAIRS 1048576         // at a time
#define ATTRIBUTE_PART_VOXELS 1048576   // occupied voxels at a time
#define ATTRIBUTE_SUM_WORDS 14
#define ATTRIBUTE_SMALL_BOX 4096        // voxels of a triangle's box that one thread lists
#define ATTRIBUTE_SAMPLE_ROWS 8         // a textured piece is cut in up to the square of this
// Sums are multiples of 2^-44, up to 2^20 faces of a voxel. What has no area weighs 2^-22, and a piece on which no sample
// passes the mask, nor a texel beside it, 2^-36.
#define ATTRIBUTE_HIGH_UNIT 4096.0  // the high word of a sum counts 2^-12
#define ATTRIBUTE_LEAST_WEIGHT 2.384185791015625e-7
#define ATTRIBUTE_HIDDEN_WEIGHT 1.4551915228366851806640625e-11

// The raster methods. A target holds one slice a bit of its four channels; eight of them are the most that any driver
// draws to at once. More slices go in several passes.
#define RASTER_TARGET_SLICES 128
#define RASTER_TARGETS 8
#define RASTER_TARGET_MIB 256  // all targets of a pass together
// What is drawn, each kind with a list of its own: proper triangles, segments and points (also those that degenerate
// triangles are), and triangles that reach so many voxels past a tile that the driver's clipping would bend them.
#define RASTER_TRIANGLES 0
#define RASTER_SEGMENTS 1
#define RASTER_POINTS 2
#define RASTER_FAR 3
#define RASTER_KINDS 4
#define RASTER_FAR_VOXELS 8192

// Alpha masks (shaders/voxelize/alpha_mask.glsl, voxelizer/surface/exact_mask.h). Texture coordinates are rounded to
// 1 / TEXCOORD_UNITS when a surface is built, to 1 / TEXEL_UNITS of a texel when a mask is read.
#define TEXCOORD_UNITS 67108864.0
#define TEXCOORD_LIMIT 1048576.0
#define TEXEL_UNITS 256
#define TEXEL_COORDINATE_LIMIT 33554432.0

// Surfaces that move (shaders/voxelize/deform.comp.glsl).
#define DEFORM_GROUP 64
#define DEFORM_NONE 4294967295u
#define DEFORM_TURNS 16384  // morph targets and influences of a vertex: loop turns. Past it, the CPU deforms.

// Bits of SurfaceMaterial.flags
#define MATERIAL_WRAP_S_SHIFT 0  // 2 bits: 0 repeat, 1 mirrored repeat, 2 clamp to edge
#define MATERIAL_WRAP_T_SHIFT 2
#define MATERIAL_MASK_BIT 16     // alpha-masked: texels under the cutoff are holes

// NodeEntry.brick: the slot + 1, and what is known of the tile.
#define NODE_SLOT 0x00FFFFFFu
#define NODE_PRODUCED 0x10000000u  // it has been produced, and the flags below tell what it turned out to be
#define NODE_FINAL 0x20000000u     // nothing finer adds to it: it has no children
#define NODE_EMPTY 0x40000000u     // constant, and the value is 0
#define NODE_CONSTANT 0x80000000u  // one value is all that it holds at its own level: it has no brick

// The tile queries of one pass; what finds no room is asked for again by the next pass.
#define QUERY_CAPACITY 65536
#define QUERY_COUNTS 65536  // counts of the rays that ask, behind the queries; a query's is number query % QUERY_COUNTS
#define QUERY_CHILDREN 0  // the node must be subdivided
#define QUERY_BRICK 1     // the node's brick must be produced
#define QUERY_STAND_IN 2  // the node's brick could stand in for what is missing below it
// Of the queries that find no room, one of each rank is kept, behind the counts: for the children of a node, the rank is its
// level; then bricks; then the missing tiles of windows, each its own. So the CPU always learns of the most urgent one.
#define QUERY_RANK_BRICK 63
#define QUERY_RANK_WINDOWS 64
#define QUERY_RANKS 576

// What rays tell by blocks of pixels (shaders/march/tile_blocks.comp.glsl): a query, or the slot of a brick that was used.
#define TILE_BLOCK_SIDE 16
#define TILE_BLOCK_ENTRIES 4
#define TILE_REPORT_NONE 4294967295u
#define TILE_REPORT_USED 2147483648u  // plus the slot

// Cells that a ray may cross in one pass. Past it the ray pauses between two tiles and goes on in the next pass, so that no
// dispatch runs for long, and no thread turns its loops more often than a driver lets it. On llvmpipe up to 16 threads
// go together, and each turn that any of them takes counts for all: where they part ways, their turns add up.
#define TURN_BUDGET 2048

// Voxels across the root cube stay below this, because a ray state packs three coordinates in 63 bits.
#define MAX_RESOLUTION_BITS 21

// Deeper trees are marched through windows (renderer/march/windows.h): cubes of 2^3 tiles around the eye, one a level.
// Log2 of a window's tile, at most, in the voxels that the ray counts in: floats tell 2^-7 of one.
#define WINDOW_TILE_BITS 16
#define MAX_WINDOWS 64
// A tile of a window: the number of its entry, or
#define WINDOW_EMPTY 4294967295u    // there is nothing in it
#define WINDOW_MISSING 2147483648u  // plus the entry of its nearest ancestor, which must be subdivided

// A normal that looks away from the viewer by less than this (cosine) belongs to a silhouette, not to a back side. A voxel
// tells by its two normals how far its surface bends; it is taken for flat when they tell less than the second number.
#define SILHOUETTE_BEND 0.35
#define VOXEL_SILHOUETTE_BEND 0.1

// How a ray finds its next tile; in this order in renderer/march/traversal.h.
#define TRAVERSAL_RESTART 0
#define TRAVERSAL_STACKLESS 1
#define TRAVERSAL_MINI_STACK 2

// Rays of a block of PIXEL_BLOCK_SIDE^2 pixels start together (renderer/march/block_starts.h).
#define PIXEL_BLOCK_SIDE 8

// Ends of shadow rays to a directional light: a grid across its direction (renderer/march/shadow_ends.h).
#define SHADOW_ENDS_SIDE 128

// What a picture shows; in this order in renderer.h.
#define SHOW_SURFACE 0
#define SHOW_LEVELS 1
#define SHOW_BRICKS 2
#define SHOW_LIGHT 3  // bits of a float instead of a colour: the share of the light that arrives, SHOWN_NOTHING: nowhere
#define SHOWN_NOTHING (-1.0)

// What a light with an extent is; in this order in renderer.h.
#define LIGHT_CONE 0       // a sphere, or a directional light with an angle: even in solid angle
#define LIGHT_RECTANGLE 1  // even in area
#define LIGHT_DISK 2
#define MAX_SHADOW_RAYS 512

// Colours of tree levels: 0.5 + 0.5 cos(LEVEL_HUE * level + phase), one phase a channel.
#define LEVEL_HUE 2.4
#define LEVEL_PHASE_R 0.6
#define LEVEL_PHASE_G 4.8
#define LEVEL_PHASE_B 2.7

// Meshes that are rasterized: triangles a draw call, pixels of a picture that are drawn at once (in whole rows), the
// distance of what is not there, and how near the eye a mesh may come, in sides of the mesh.
#define MESH_BATCH_TRIANGLES 262144
#define MESH_STRIP_PIXELS 4194304
#define MESH_MISS 1e30
// A voxel that touches a triangle has its centre at most half a diagonal from its plane; a little more, where the surface
// bends.
#define MESH_OWN_HEIGHT 1.125
#define MESH_NEAREST_PART 9.5367431640625e-7
// Densities that a brick tells apart; a transfer function is linear between them.
#define DENSITY_STEPS 256
// A voxel's chord is cut in at most so many steps.
#define VOLUME_MOST_STEPS 32

// The xy-reduced pyramid (renderer/shadow/column_pyramid.h): bits of a column that one fetch reads, and what is tested of a
// column, in the order of renderer/shadow/column_mask.h.
#define COLUMN_TEXEL_BITS 128
#define COLUMN_MASK_MIP_LEVEL 0
#define COLUMN_MASK_ADAPTIVE 1
// Voxels a side, log2. A ray turns its loops fewer than 12 times for each, which past TURN_BUDGET must stay under the turns
// that llvmpipe grants (VOXEL_REGION_SIDE).
#define COLUMN_LEAST_LEVELS 3
#define COLUMN_MOST_LEVELS 11

// A ray stops when less light than this is left: half a step of an 8-bit image.
#define OPAQUE_TRANSMITTANCE (1.0 / 512.0)

// Soft shadow maps. Inverse depths stand in textures; no surface is ever as close to the light as this one.
#define SHADOW_NONE 1e30
#define SHADOW_LIST_GROUP 32
#define SHADOW_COUNT_PATCHES 0
#define SHADOW_COUNT_FRAGMENTS 1  // texels of all penumbra extents: low word, then high word
#define SHADOW_COUNT_ROWS 3
// Texels that a penumbra extent reaches past where rounding may have put its edges.
#define SHADOW_EXTENT_SLACK 0.0625

#endif

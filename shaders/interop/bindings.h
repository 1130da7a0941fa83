// OpenGL binding numbers, each kind apart, so the prefix names the kind. Read by C++ and GLSL.
#ifndef CAIRN_INTEROP_BINDINGS_H
#define CAIRN_INTEROP_BINDINGS_H

// The surface: what voxelize/ and produce/ read.
#define SSBO_SURFACE_POSITIONS 0   // int[3] a vertex, lattice units
#define SSBO_SURFACE_TRIANGLES 1   // SurfaceTriangle
#define SSBO_SURFACE_ATTRIBUTES 2  // SurfaceAttributes a vertex
#define SSBO_SURFACE_MATERIALS 3   // SurfaceMaterial
#define SSBO_SURFACE_TEXELS 4      // RGBA8 texels of all images, one uint each; then the counts of masks

// The voxelizer's own.
#define SSBO_VOXEL_BITS 5    // BitGrid::words
#define SSBO_VOXEL_QUEUE 6   // VOXEL_QUEUE_* counters, then the queues
#define SSBO_VOXEL_SUBSET 7  // triangles to mark, when not all
#define SSBO_VOXEL_CANDIDATES 7  // voxels that a mask may cut away (shaders/voxelize/candidates.glsl)
#define TEXTURE_HALVE_FINE 0  // BitGrid::words of a level; those of the next coarser one (passes that read no surface)
#define SSBO_HALVE_COARSE 0

// What moves a surface (shaders/voxelize/deform.comp.glsl), beside SSBO_SURFACE_POSITIONS and _ATTRIBUTES.
#define SSBO_DEFORM_VERTICES 1    // uvec4 a vertex. xyz: bits of its floats at rest, in mesh space; w: its DeformItem
#define SSBO_DEFORM_VECTORS 3     // float[3] each: normals at rest, and displacements of morph targets
#define SSBO_DEFORM_INFLUENCES 4  // DeformInfluences
#define SSBO_DEFORM_ITEMS 5       // DeformItem
#define SSBO_DEFORM_MATRICES 6    // double[12] each: four columns of three
#define SSBO_DEFORM_FRAME 7       // DeformHeader, then DeformTarget

// Attributes of voxels: the pass that lists pairs reads of the surface only 0, 1 and 3, the one that gathers reads all.
#define SSBO_ATTRIBUTE_RANKS 2   // occupied voxels before every VOXEL_RANK_WORDS words of the bits
#define SSBO_ATTRIBUTE_SUBSET 4  // triangles to list, when not all
#define SSBO_ATTRIBUTE_SUMS 6    // ATTRIBUTE_SUM_WORDS an occupied voxel (shaders/voxelize/attribute_sums.glsl)
#define SSBO_ATTRIBUTE_PAIRS 7   // which triangle touches which voxel (shaders/voxelize/attribute_pairs.glsl)
#define SSBO_RASTER_LISTS 6  // primitives to rasterize (shaders/voxelize/raster_lists.glsl)
#define TEXTURE_SLICES 0     // a target of the raster methods, when its slices are joined
#define ATTRIBUTE_POSITION 0

// The producer's own (beside the surface's 0 to 4).
#define SSBO_BRICK_PAIRS 5    // BrickPair: which triangle touches which tile of the batch
#define SSBO_BRICK_TILES 6    // BrickTile: the tiles of the batch
#define SSBO_BRICK_SCRATCH 7  // masks, then sums, of every voxel of the batch (scratch.glsl)
#define SSBO_BRICK_MASKS 0    // masks and summaries of the brick pool (resolve passes, which read no surface)
#define SSBO_BRICK_FOUND 1    // a word a tile of the batch: not 0 where any of its voxels is occupied (the same passes)
#define IMAGE_BRICK_COLOR 0
#define IMAGE_BRICK_NORMAL 1

// The marcher.
#define UBO_VIEW 0
#define UBO_WINDOWS 1  // their number, then MarchWindow from the finest on; only for trees that are marched through them
#define SSBO_RAYS 0     // RayState a pixel
#define SSBO_LISTS 1    // pixels that wait: four lists of one pixel count each
#define SSBO_QUERIES 2  // MarchCounters, then the tile query buffer
#define SSBO_USAGE 3    // the last pass that used each brick; then bits: queries already made in this pass
#define SSBO_TILE_REPORTS 3  // a word a pixel, in place of SSBO_USAGE where rays tell by blocks of pixels
#define SSBO_TILE_BLOCKS 5   // TILE_BLOCK_ENTRIES words a block (the pass that reduces them, which reads no block starts)
#define SSBO_IMAGE 4    // RGBA8 a pixel
#define SSBO_BLOCK_STARTS 5
#define SSBO_SHADOW_SUMS 6  // uvec2 a pixel: samples of the light that are done, and bits of the light they found
#define TEXTURE_NODES 0
#define TEXTURE_BRICK_MASKS 1
#define TEXTURE_BRICK_COLOR 2   // or coverage alone
#define TEXTURE_BRICK_NORMAL 3
#define TEXTURE_NODE_MEANS 5    // RGBA8 in a uint, a node entry: what constant tiles hold
#define TEXTURE_SHADOW_ENDS 4
#define TEXTURE_MESH_NEAREST 8   // R32F a pixel: distance of the nearest mesh, MESH_MISS where there is none
#define TEXTURE_MESH_SURFACE 9   // RGBA32UI a pixel: what is there (shaders/mesh/mesh_surface.glsl)
#define TEXTURE_PROXY_SPAN 10    // RG32F a pixel: distance of the proxy's first face, minus that of its last
#define TEXTURE_PROXY_FACES 11   // R32F a pixel: fronts less backs

// Shadow rays through the xy-reduced pyramid (beside the marcher's UBO_VIEW, SSBO_IMAGE, SSBO_SHADOW_SUMS and
// TEXTURE_MESH_*).
#define SSBO_COLUMN_COUNTS 2  // pixels whose rays go on in the next pass
#define SSBO_COLUMNS 0        // texels of a coarser level, when it is built
#define TEXTURE_COLUMNS 0     // all levels, COLUMN_TEXEL_BITS a texel

// Meshes that are rasterized (beside the surface's 0 to 4, and UBO_VIEW).
#define UBO_MESH_VIEW 1
#define SSBO_MESH_TRIANGLES 5  // MeshTriangle: a batch of triangles, as this view sees them

// Of volumes (shaders/march/volume.glsl).
#define UBO_VOLUME 3
#define TEXTURE_TRANSFER 12  // DENSITY_STEPS^2 texels: column s0, row s1; rgb: mean emission, a: mean extinction

// The soft shadow map. Its passes bind only these, and draw nothing of the marcher's.
#define ATTRIBUTE_SHADOW_POSITION 0
#define ATTRIBUTE_SHADOW_NORMAL 1
#define ATTRIBUTE_SHADOW_COLOR 2
#define ATTRIBUTE_SHADOW_TEXCOORD 3
#define ATTRIBUTE_SHADOW_PATCH 0     // MicroPatch, one an instance
#define TEXTURE_SHADOW_BASE_COLOR 0  // of the material that is drawn
#define TEXTURE_SHADOW_OCCLUDERS 0   // inverse depths: the closest occluders, or the furthest
#define TEXTURE_SHADOW_RECEIVERS 1   // inverse depths; 0 = no receiver
#define TEXTURE_SHADOW_PYRAMID 2     // the least inverse depth of receivers, level by level; SHADOW_NONE = none
#define TEXTURE_SHADOW_HIDDEN 3      // sums of what micro-patches hide of the light
#define TEXTURE_SHADOW_HIDDEN_FURTHEST 4
#define TEXTURE_SHADOW_VISIBLE 5     // the soft shadow map
#define IMAGE_SHADOW_LEVEL 0         // what a compute pass writes
#define SSBO_SHADOW_COUNTS 0         // SHADOW_COUNT_*, then the micro-patches of each row of the occluder map
#define SSBO_SHADOW_PATCHES 1        // MicroPatch

#endif

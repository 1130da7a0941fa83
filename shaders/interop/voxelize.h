// The voxelizer: bits of voxels, the queues of its methods, and the attributes of voxels.
#ifndef CAIRN_INTEROP_VOXELIZE_H
#define CAIRN_INTEROP_VOXELIZE_H

#define SSBO_VOXEL_BITS 5    // BitGrid::words
#define SSBO_VOXEL_QUEUE 6   // VOXEL_QUEUE_* counters, then the queues
// The next two share a number, because GL promises eight: each pass binds its own anew.
#define SSBO_VOXEL_SUBSET 7      // numbers of the triangles to mark, if not all
#define SSBO_VOXEL_CANDIDATES 7  // voxels that a mask may cut away (shaders/voxelize/candidates.glsl)

// Bindings of passes that read no surface: a level of the bitmask pyramid, and the next coarser one.
#define TEXTURE_HALVE_FINE 0  // BitGrid::words
#define SSBO_HALVE_COARSE 0

// A triangle of at most VOXEL_SMALL_ROWS rows is marked by the thread that reads it. Larger ones wait in
// queues, and are shared by so many threads that each thread has about VOXEL_THREAD_ROWS rows.
#define VOXEL_SMALL_ROWS 64
#define VOXEL_THREAD_ROWS 64
// The first of VOXEL_SHARED_CLASSES queues. A triangle of class c is shared by VOXEL_SHARED_LEAST *
// VOXEL_SHARED_FACTOR^c threads; one of the last class, by as many as the largest triangle of the region may
// need.
#define VOXEL_QUEUE_SHARED 0
#define VOXEL_SHARED_CLASSES 6
#define VOXEL_SHARED_LEAST 8
#define VOXEL_SHARED_FACTOR 4
// Triangles that a mask cuts: those with a box of at most VOXEL_MASKED_SMALL_BOX voxels, and larger ones.
#define VOXEL_QUEUE_MASKED_SMALL 6
#define VOXEL_MASKED_SMALL_BOX 4096
#define VOXEL_QUEUE_MASKED_LARGE 7
#define VOXEL_QUEUE_DOUBT 8  // triangles of few rows that the float filter could not decide
#define VOXEL_QUEUE_COUNT 9
// llvmpipe ends every loop of an invocation, without an error, once its loops have turned 65535 times in all.
// Two limits keep well under that: voxels along an axis of a region, and steps to decide about one voxel of a
// masked triangle.
#define VOXEL_REGION_SIDE 16384
#define MASK_STEPS 1024
#define MASK_EMPTY 0
#define MASK_SURFACE 1
#define MASK_UNDECIDED 2      // left to the CPU: too many steps, or vertex alphas under 1

// Attributes of voxels (voxelizer/methods/voxel_attributes.h). Of the surface's bindings, the pass that lists
// pairs reads only 0, 1 and 3; the pass that gathers reads all.
#define SSBO_ATTRIBUTE_RANKS 2   // number of occupied voxels before every VOXEL_RANK_WORDS words of the bits
#define SSBO_ATTRIBUTE_SUBSET 4  // numbers of the triangles to list, if not all
// ATTRIBUTE_SUM_WORDS per occupied voxel (shaders/voxelize/attribute_sums.glsl).
#define SSBO_ATTRIBUTE_SUMS 6
#define SSBO_ATTRIBUTE_PAIRS 7   // which triangle touches which voxel (shaders/voxelize/attribute_pairs.glsl)
#define VOXEL_RANK_WORDS 8
#define ATTRIBUTE_SUM_WORDS 14
#define ATTRIBUTE_SMALL_BOX 4096        // voxels of a triangle's box that one thread lists
#define ATTRIBUTE_SAMPLE_ROWS 8         // a textured piece is cut in at most the square of this many parts
// Sums are multiples of 2^-44, up to 2^20 faces of a voxel. A piece without area weighs 2^-22. A piece on
// which no sample passes the mask, nor any texel beside the samples, weighs 2^-36.
#define ATTRIBUTE_HIGH_UNIT 4096.0  // the high word of a sum counts 2^-12
#define ATTRIBUTE_LEAST_WEIGHT 2.384185791015625e-7
#define ATTRIBUTE_HIDDEN_WEIGHT 1.4551915228366851806640625e-11

// The raster methods. A target holds one slice per bit of its four channels. Eight targets are the most that
// every driver can draw to at once; more slices take several passes.
#define SSBO_RASTER_LISTS 6  // primitives to rasterize (shaders/voxelize/raster_lists.glsl)
#define TEXTURE_SLICES 0     // a target of the raster methods, when its slices are joined
#define RASTER_TARGET_SLICES 128
#define RASTER_TARGETS 8
// Kinds of primitives, each with its list: proper triangles; segments and points (degenerate triangles among
// them); and triangles that reach more than RASTER_FAR_VOXELS past a tile, so that the driver's clipping
// would bend them.
#define RASTER_TRIANGLES 0
#define RASTER_SEGMENTS 1
#define RASTER_POINTS 2
#define RASTER_FAR 3
#define RASTER_KINDS 4
#define RASTER_FAR_VOXELS 8192

#endif

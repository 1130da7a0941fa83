// Read by C++ and GLSL 4.50: comments, guards and numeric #defines only.
#ifndef CAIRN_INTEROP_CONFIG_H
#define CAIRN_INTEROP_CONFIG_H

// Vertices are rounded once to this lattice; the root cube of a grid is 2^LATTICE_BITS units a side.
#define LATTICE_BITS 24

// A surface is cut in chunks of at most this many triangles, so that each of its buffers stays under the smallest
// shader-storage limit in use (128 MiB). A triangle's global number is chunk * SURFACE_CHUNK_TRIANGLES + local.
#define SURFACE_CHUNK_TRIANGLES 2097152

// Bits of SurfaceMaterial.flags
#define MATERIAL_WRAP_S_SHIFT 0  // 2 bits: 0 repeat, 1 mirrored repeat, 2 clamp to edge
#define MATERIAL_WRAP_T_SHIFT 2
#define MATERIAL_MASK_BIT 16     // alpha-masked: texels under the cutoff are holes

// The tile queries of one pass; what finds no room is asked for again by the next pass.
#define QUERY_CAPACITY 65536
#define QUERY_CHILDREN 0  // the node must be subdivided
#define QUERY_BRICK 1     // the node's brick must be produced

// Voxels across the root cube stay below this, because a ray state packs three coordinates in 63 bits.
#define MAX_RESOLUTION_BITS 21

// A brick voxel is opaque to 1 - 1/256 when its coverage is full, so that a ray that only cuts its corner is not.
#define FULL_COVERAGE_TRANSMITTANCE (1.0 / 256.0)
// A ray stops when less light than this is left: half a step of an 8-bit image.
#define OPAQUE_TRANSMITTANCE (1.0 / 512.0)

#endif

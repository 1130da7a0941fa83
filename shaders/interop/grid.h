// The lattice that positions are rounded to (voxelizer/grid.h). Read by C++ and GLSL.
#ifndef CAIRN_INTEROP_GRID_H
#define CAIRN_INTEROP_GRID_H

// Vertices are rounded once to this lattice; the root cube of a grid is 2^LATTICE_BITS units along each
// side.
#define LATTICE_BITS 24
// World coordinates further away than this many lattice units are an error.
#define LATTICE_WORLD_LIMIT 1099511627776.0

#endif

// OpenGL binding numbers, each kind apart, so the prefix names the kind. Read by C++ and GLSL.
#ifndef CAIRN_INTEROP_BINDINGS_H
#define CAIRN_INTEROP_BINDINGS_H

// The surface: what voxelize/ and produce/ read.
#define SSBO_SURFACE_POSITIONS 0   // int[3] a vertex, lattice units
#define SSBO_SURFACE_TRIANGLES 1   // SurfaceTriangle
#define SSBO_SURFACE_ATTRIBUTES 2  // SurfaceAttributes a vertex
#define SSBO_SURFACE_MATERIALS 3   // SurfaceMaterial
#define SSBO_SURFACE_TEXELS 4      // RGBA8 texels of all images, one uint each

#endif

// What the flags of a material say.
#include "interop/surface.h"

// Does an alpha mask cut holes in the surface?
bool is_masked(SurfaceMaterial material) { return (material.flags >> MATERIAL_MASK_BIT & 1u) != 0u; }

uint wrap_s_of(SurfaceMaterial material) { return material.flags >> MATERIAL_WRAP_S_SHIFT & 3u; }
uint wrap_t_of(SurfaceMaterial material) { return material.flags >> MATERIAL_WRAP_T_SHIFT & 3u; }

// Volumes (shaders/march/volume.glsl).
#ifndef CAIRN_INTEROP_VOLUME_H
#define CAIRN_INTEROP_VOLUME_H

#define UBO_VOLUME 3
// DENSITY_STEPS^2 texels, at column s0 and row s1: mean emission (rgb) and mean extinction (a) from density
// s0 to s1.
#define TEXTURE_TRANSFER 12

// Number of densities that a brick can hold; a transfer function is linear between them.
#define DENSITY_STEPS 256
// Greatest number of steps that the chord of a voxel is cut in.
#define VOLUME_MOST_STEPS 32

#ifdef __cplusplus
namespace cairn::interop {
#endif

// A volume, as rays read it.
struct VolumeView {
    float voxel_size;     // side of a voxel of the finest level, world units
    // A gradient of this steepness (densities per voxel) is lit as a surface, a gradient of 0 as fog. 0: all
    // is fog.
    float full_gradient;
    // Distance from the receiver at which a shadow ray starts, in voxels of the level that the receiver is
    // seen at.
    float shadow_start;
    float padding;
};

#ifdef __cplusplus
static_assert(sizeof(VolumeView) == 16, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

// Volumes (shaders/march/volume.glsl).
#ifndef CAIRN_INTEROP_VOLUME_H
#define CAIRN_INTEROP_VOLUME_H

#define UBO_VOLUME 3
// DENSITY_STEPS^2 texels: column s0, row s1; rgb: mean emission, a: mean extinction.
#define TEXTURE_TRANSFER 12

// Densities that a brick tells apart; a transfer function is linear between them.
#define DENSITY_STEPS 256
// A voxel's chord is cut in at most so many steps.
#define VOLUME_MOST_STEPS 32

#ifdef __cplusplus
namespace cairn::interop {
#endif

// What rays through a volume need to know. Lengths in voxels of the finest level.
struct VolumeView {
    float voxel_size;     // world units
    // Densities per voxel: a gradient so steep is lit as a surface, one of 0 as fog; 0: all is fog.
    float full_gradient;
    float shadow_start;   // a shadow ray starts so many voxels of the level that is seen from the point
    float padding;
};

#ifdef __cplusplus
static_assert(sizeof(VolumeView) == 16, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

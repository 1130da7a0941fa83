// The ray-marcher: what rays know of the view, their states between passes, and their counters.
#ifndef CAIRN_INTEROP_MARCH_H
#define CAIRN_INTEROP_MARCH_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define UBO_VIEW 0           // MarchView
#define SSBO_RAYS 0          // RayState per pixel
#define SSBO_LISTS 1         // pixels that wait: four lists of one pixel count each
#define SSBO_PICTURE 4       // a word per pixel (shaders/march/picture.glsl)
#define SSBO_BLOCK_STARTS 5  // BlockStart

// Cells that a ray may cross in one pass. Past it the ray pauses between two tiles and goes on in the next
// pass, so that no dispatch runs for long, and no thread turns its loops more often than a driver lets it. On
// llvmpipe up to 16 threads go together, and each turn that any of them takes counts for all: where they part
// ways, their turns add up.
#define TURN_BUDGET 2048

// A ray stops when less light than this is left: half a step of an 8-bit image. Less coverage than this shows
// nothing.
#define OPAQUE_TRANSMITTANCE (1.0 / 512.0)
#define LEAST_COVERAGE (1.0 / 512.0)

// A normal that looks away from the viewer by less than this (cosine) belongs to a silhouette, not to a back
// side. A voxel tells by its two normals how far its surface bends; it is taken for flat when they tell less
// than the second number.
#define SILHOUETTE_BEND 0.35
#define VOXEL_SILHOUETTE_BEND 0.1

// How a ray finds its next tile: enum Traversal of renderer/march/traversal.h.
#define TRAVERSAL_RESTART 0
#define TRAVERSAL_STACKLESS 1
#define TRAVERSAL_MINI_STACK 2

// Rays of a block of PIXEL_BLOCK_SIDE^2 pixels start together (renderer/march/block_starts.h).
#define PIXEL_BLOCK_SIDE 8

// What a picture shows. The first three are enum Show of renderer/view/view.h.
#define SHOW_SURFACE 0
#define SHOW_LEVELS 1
#define SHOW_BRICKS 2
// Bits of a float instead of a colour: the share of the light that arrives, SHOWN_NOTHING: nowhere.
#define SHOW_LIGHT 3
#define SHOWN_NOTHING (-1.0)

// Colours of tree levels: 0.5 + 0.5 cos(LEVEL_HUE * level + phase), one phase per channel.
#define LEVEL_HUE 2.4
#define LEVEL_PHASE_R 0.6
#define LEVEL_PHASE_G 4.8
#define LEVEL_PHASE_B 2.7

#ifdef __cplusplus
namespace cairn::interop {
#endif

// What rays know of a view. All lengths in voxels of the finest level, positions from the root cube's low
// corner. Where rays go through windows, `eye`, `light` and `light_is_positional` stand in MarchWindow
// instead. Buffers of pixels hold the band alone: the rows of the picture that are marched at once.
struct MarchView {
    vec3 eye;                  // moved forward to near the root cube, for the precision of floats
    float pixel_cone;          // width of a pixel's cone at distance 1
    vec3 forward;              // unit
    // Rays start this far from the eye, in the plane across `forward` that `eye` lies in.
    float skipped;
    vec3 right;                // half the picture's width at distance 1
    int width;                 // of the picture, in pixels
    vec3 up;                   // half the picture's height at distance 1
    int height;                // of the picture, in pixels
    vec3 light;                // position, or unit direction to the light
    int light_is_positional;   // 1: `light` is a position
    vec3 light_color;
    float ambient;             // light from everywhere, as a share of the light's own
    vec3 background;
    uint background_pixel;     // the same, as the picture holds it
    vec3 surface_color;        // base colour everywhere, when the pool holds none
    int shown;                 // SHOW_*
    vec3 shadow_across;        // ShadowEnds::across, when there are shadow ends
    float shadow_across_offset;
    vec3 shadow_down;          // ShadowEnds::down
    float shadow_down_offset;
    vec3 light_half_u;         // half axis of a light with an extent, from its middle
    float light_radius;        // of a sphere
    vec3 light_half_v;         // the other half axis
    float light_cosine_loss;   // 1 - cosine of a directional light's angle
    int first_row;             // of the band
    int row_count;             // of the band
    int casts_shadows;         // 1: trace shadow rays
    int has_shadow_ends;       // 1: there are ShadowEnds
    int shadow_rays;           // per pixel
    int light_shape;           // LIGHT_*
    int is_soft;               // 1: shadow rays go to samples of the light; 0: one goes to its middle
    int is_cones;              // 1: soft shadow rays are cones
    float shadow_cone_scale;   // width of shadow rays, in widths of their pixels' cones
    int padding1, padding2, padding3;
};

// A ray between two passes, by the functions of shaders/march/ray_state.glsl.
struct RayState {
    vec4 color;            // rgb: gathered, premultiplied; a: transmittance
    vec3 normal;           // gathered; of a volume, what the light adds to its colour
    float depth;           // distance of the voxel that weighs most: where shadow rays start
    uvec2 place;           // packed voxel where the ray stands, or RAY_NOT_STARTED in place.y
    float distance;        // of the ray, to there
    // Primary: the greatest weight so far. Shadow: what the ray has been left of the light.
    float weight;
};
// The highest bit of RayState.place.y, which no packed voxel has.
#define RAY_NOT_STARTED 0x80000000u

// A block of PIXEL_BLOCK_SIDE^2 pixels, and where its rays may meet anything.
struct BlockStart {
    uint block;            // number in the band, row after row
    float near;            // distances from the eye
    float far;
};

struct MarchCounters {
    uint waiting_primary;
    uint waiting_shadow;
    uint queries;
    uint paused;           // rays that used up the pass's turns and go on in the next
    uint stood_in;         // tiles that were missing and that no ray waited for
    uint launched;         // rays that a proxy let run
};

#ifdef __cplusplus
static_assert(sizeof(MarchView) == 240, "GLSL sees another layout");
static_assert(offsetof(MarchView, light) == 64, "GLSL sees another layout");
static_assert(offsetof(MarchView, first_row) == 192, "GLSL sees another layout");
static_assert(sizeof(RayState) == 48, "GLSL sees another layout");
static_assert(offsetof(RayState, place) == 32, "GLSL sees another layout");
static_assert(sizeof(BlockStart) == 12, "GLSL sees another layout");
static_assert(sizeof(MarchCounters) == 24, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif

// The ray-marcher: the view as rays read it, the states of rays between passes, and counters of rays.
#ifndef CAIRN_INTEROP_MARCH_H
#define CAIRN_INTEROP_MARCH_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define UBO_VIEW 0           // MarchView
#define SSBO_RAYS 0          // RayState per pixel
#define SSBO_LISTS 1         // numbers of pixels that wait: four lists, each with room for all pixels
#define SSBO_PICTURE 4       // a word per pixel (shaders/march/picture.glsl)
#define SSBO_BLOCK_STARTS 5  // BlockStart

// Number of cells that a ray may cross in one pass. Past it the ray pauses between two tiles and goes on in
// the next pass, so that no dispatch runs for long, and no thread turns its loops more often than the driver
// allows. llvmpipe runs up to 16 threads together, and each turn of any of them counts for all: where they
// diverge, their turns add up.
#define TURN_BUDGET 2048

// A ray stops when less light than this is left: half a step of an 8-bit image.
#define OPAQUE_TRANSMITTANCE (1.0 / 512.0)
// Coverage below this counts as nothing.
#define LEAST_COVERAGE (1.0 / 512.0)

// A normal that looks away from the viewer by less than this (cosine) belongs to a silhouette, not to a back
// side.
#define SILHOUETTE_BEND 0.35
// The two normals of a voxel show how far its surface bends; the bend is taken to be at least this.
#define VOXEL_SILHOUETTE_BEND 0.1

// The ways in which a ray finds its next tile: enum Traversal of renderer/march/march_options.h.
#define TRAVERSAL_RESTART 0
#define TRAVERSAL_STACKLESS 1
#define TRAVERSAL_MINI_STACK 2

// Rays of a block of PIXEL_BLOCK_SIDE^2 pixels start together (renderer/march/block_starts.h).
#define PIXEL_BLOCK_SIDE 8

// The things that a picture may show. The first three are enum Show of renderer/view/view.h.
#define SHOW_SURFACE 0
#define SHOW_LEVELS 1
#define SHOW_BRICKS 2
// The bits of a float instead of a colour: the share of the light that arrives, or SHOWN_NOTHING if the pixel
// shows no surface.
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

// A view, as rays read it. Lengths are in voxels of the finest level, positions relative to the root cube's
// low corner. If rays go through windows, they read `eye`, `light` and `light_is_positional` from MarchWindow
// instead. Buffers of pixels hold the band alone: the rows of the picture that are marched at once.
struct MarchView {
    // The eye, moved forward to the root cube, for the precision of floats.
    vec3 eye;
    float pixel_cone;          // width of a pixel's cone at distance 1
    vec3 forward;              // unit
    // Distance by which `eye` was moved along `forward`. Rays start in the plane across `forward` through
    // `eye`.
    float skipped;
    vec3 right;                // half the picture's width at distance 1
    int width;                 // pixels of the whole picture
    vec3 up;                   // half the picture's height at distance 1
    int height;                // pixels of the whole picture
    vec3 light;                // position of the light, or unit direction to it
    int light_is_positional;   // 1: `light` is a position
    vec3 light_color;
    float ambient;             // light from everywhere, as a share of light_color
    vec3 background;
    uint background_pixel;     // the background as a word of the picture
    vec3 surface_color;        // base colour everywhere, if the pool holds no colours
    int shown;                 // SHOW_*
    vec3 shadow_across;        // ShadowEnds::across, if has_shadow_ends
    float shadow_across_offset;
    vec3 shadow_down;          // ShadowEnds::down
    float shadow_down_offset;
    vec3 light_half_u;         // half axis of a light with an extent, from its middle
    float light_radius;        // radius of a sphere
    vec3 light_half_v;         // the other half axis
    float light_cosine_loss;   // 1 - cosine of a directional light's angle
    int first_row;             // first row of the band in the picture
    int row_count;             // rows of the band
    int casts_shadows;         // 1: trace shadow rays
    int has_shadow_ends;       // 1: there are ShadowEnds
    int shadow_rays;           // number of shadow rays per pixel
    int light_shape;           // LIGHT_*
    // 1: shadow rays go to samples of the light; 0: one goes to its middle.
    int is_soft;
    int is_cones;              // 1: soft shadow rays are cones
    float shadow_cone_scale;   // width of shadow rays, in units of their pixels' cones
    float pixel_x, pixel_y;    // place of a pixel's ray in the pixel, from its top left corner
    int padding1;
};

// A ray between two passes. shaders/march/ray_state.glsl has the functions that read and write it.
struct RayState {
    vec4 color;            // rgb: gathered colour, premultiplied; a: transmittance
    vec3 normal;           // gathered normal; for a volume, the colour that the light adds
    // Distance of the voxel that weighs most: where shadow rays start.
    float depth;
    // Packed voxel where the ray stands, or RAY_NOT_STARTED in place.y.
    uvec2 place;
    float distance;        // distance that the ray has gone
    // Primary ray: the greatest weight so far. Shadow ray: the share of the light that is left.
    float weight;
};
// The highest bit of RayState.place.y, which no packed voxel has.
#define RAY_NOT_STARTED 0x80000000u

// A block of PIXEL_BLOCK_SIDE^2 pixels, and where its rays may meet anything.
struct BlockStart {
    uint block;            // number of the block in the band, row after row
    float near;            // least distance from the eye
    float far;             // greatest distance from the eye
};

// Counts of one pass.
struct MarchCounters {
    uint waiting_primary;  // primary rays that go on in the next pass
    uint waiting_shadow;   // shadow rays that go on or start in the next pass
    uint queries;          // tile queries
    uint paused;           // rays that used up the pass's turns and go on in the next
    uint stood_in;         // missing tiles for which an ancestor stood in
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

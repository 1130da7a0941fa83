// Shading: computes a pixel from what a primary ray gathered and the share of the light that arrives there.
#include "interop/march.h"
#include "interop/mesh.h"  // here, because a file is included once, and the next #include is under a condition
#include "common/sky_light.glsl"
#include "march/picture.glsl"
#include "march/pixel_ray.glsl"
#include "march/ray_state.glsl"

// The place of the light, in units of the window that the pixel shows most of.
struct LightPlace {
    vec3 at;  // position of the light, or unit direction to it
    bool is_positional;
};

#if WINDOWS
LightPlace light_there() {
    return LightPlace(windows.of[seen_window].light, windows.of[seen_window].light_is_positional != 0);
}
#else
LightPlace light_there() { return LightPlace(view.light, view.light_is_positional != 0); }
#endif

vec3 direction_to_light(vec3 point) {
    const LightPlace light = light_there();
    return light.is_positional ? normalize(light.at - point) : light.at;
}

// A normal, turned to the viewer, because surfaces have two sides. At a silhouette the mean normal of a voxel
// looks away only because the surface bends away within the voxel; then the surface is seen edge on.
vec3 turned_to_viewer(vec3 normal, vec3 direction) {
    const float away = dot(normal, direction);
    if (away <= 0.0) return normal;
    return away < SILHOUETTE_BEND ? normalize(normal - away * direction) : -normal;
}

// The unit normal of a sum of normals, turned to the viewer.
vec3 facing_normal(vec3 gathered, vec3 direction) {
    const float size = length(gathered);
    if (size < 1e-6) return -direction;
    return turned_to_viewer(gathered / size, direction);
}
vec3 facing_normal(RayState state, vec3 direction) { return facing_normal(state.normal, direction); }

// The light that a surface of base colour 1 sends to the viewer.
vec3 light_on(vec3 point, vec3 normal, float visibility) {
    const float facing = max(dot(normal, direction_to_light(point)), 0.0);
    const float sky = view.ambient * sky_share(normal);
    return view.light_color * (sky + (1.0 - view.ambient) * facing * visibility);
}

vec3 light_on_voxels(RayState state, PixelRay seen, float visibility) {
    const vec3 normal = facing_normal(state, seen.direction);
    return light_on(seen.origin + seen.direction * state.depth, normal, visibility);
}

// Whether the picture shows the share of the light instead of colours.
bool shows_light() { return view.shown == SHOW_LIGHT; }

// The share of the light that arrives at a surface; 0 if the surface turns its back to the light.
float light_at(vec3 point, vec3 normal, float visibility) {
    return dot(normal, direction_to_light(point)) > 0.0 ? visibility : 0.0;
}

float light_at_voxels(RayState state, PixelRay seen, float visibility) {
    const vec3 point = seen.origin + seen.direction * state.depth;
    return light_at(point, facing_normal(state, seen.direction), visibility);
}

void write_pixel(ivec2 pixel, RayState state, float visibility) {
    const uint index = pixel_index(pixel);
    const float alpha = 1.0 - state.color.a;
    if (shows_light()) {
        store_number(index, alpha > 0.0 ? light_at_voxels(state, pixel_ray(pixel), visibility) : SHOWN_NOTHING);
        return;
    }
    if (alpha > 0.0) {
        const vec3 light = light_on_voxels(state, pixel_ray(pixel), visibility);
        store_color(index, state.color.rgb * light + state.color.a * view.background, alpha);
    } else {
        store_background(index);
    }
}

#if WITH_MESHES
#include "mesh/mesh_surface.glsl"

vec3 mesh_point(MeshPixel mesh, PixelRay seen) { return seen.origin + seen.direction * mesh.t; }

// The interpolated normal, on the side of the triangle that is seen. At a silhouette it may still look away
// from the viewer; then it is turned until it is seen edge on.
vec3 mesh_normal(MeshPixel mesh, PixelRay seen) {
    const vec3 normal = dot(mesh.normal, mesh.plane) < 0.0 ? -mesh.normal : mesh.normal;
    return normalize(normal - max(dot(normal, seen.direction), 0.0) * seen.direction);
}

// Whether light can arrive at the mesh and the mesh is visible, so that a shadow ray must look for the light.
bool mesh_needs_shadow_ray(MeshPixel mesh, PixelRay seen, float transmittance) {
    if (!mesh_shadows || view.casts_shadows == 0) return false;
    if (!is_there(mesh) || transmittance < OPAQUE_TRANSMITTANCE) return false;
    // Shading uses the interpolated normal; the share of the light that is shown depends on the triangle's
    // plane.
    const vec3 normal = shows_light() ? mesh.plane : mesh_normal(mesh, seen);
    return dot(normal, direction_to_light(mesh_point(mesh, seen))) > 0.0;
}

// The colour behind the voxels: the mesh, or the background, whose alpha is 0.
vec4 lit_mesh(MeshPixel mesh, PixelRay seen, float mesh_visibility) {
    if (!is_there(mesh)) return vec4(view.background, 0.0);
    const vec3 normal = mesh_normal(mesh, seen);
    return vec4(mesh.color * light_on(mesh_point(mesh, seen), normal, mesh_visibility), 1.0);
}

void write_pixel(ivec2 pixel, RayState state, float visibility, MeshPixel mesh, float mesh_visibility) {
    const uint index = pixel_index(pixel);
    const PixelRay seen = pixel_ray(pixel);
    if (shows_light()) {
        const float on_mesh = light_at(mesh_point(mesh, seen), mesh.plane, mesh_visibility);
        const float on_voxels = light_at_voxels(state, seen, visibility);
        if (is_there(mesh)) {
            store_number(index, mix(on_voxels, on_mesh, state.color.a));
        } else {
            store_number(index, state.color.a < 1.0 ? on_voxels : SHOWN_NOTHING);
        }
        return;
    }
    vec4 color = state.color.a * lit_mesh(mesh, seen, mesh_visibility);
    const float alpha = 1.0 - state.color.a;
    if (alpha > 0.0) color += vec4(state.color.rgb * light_on_voxels(state, seen, visibility), alpha);
    store_color(index, color.rgb, color.a);
}
#endif

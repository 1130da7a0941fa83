// From what a primary ray gathered and how much of the light reaches it, to a pixel.
#include "march/pixel_ray.glsl"

// Linear to sRGB (IEC 61966-2-1).
vec3 srgb_from_linear(vec3 c) {
    const vec3 clamped = clamp(c, 0.0, 1.0);
    return mix(12.92 * clamped, 1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055, greaterThan(clamped, vec3(0.0031308)));
}

#if WINDOWS
vec4 light_there() { return windows.of[seen_window].light; }
#else
vec4 light_there() { return view.light; }
#endif

vec3 direction_to_light(vec3 point) {
    const vec4 light = light_there();
    return light.w > 0.5 ? normalize(light.xyz - point) : light.xyz;
}

// A normal, turned to the viewer: surfaces have two sides. At a silhouette a voxel's mean looks away only because its
// surface bends away in it, and is seen edge on.
vec3 turned_to_viewer(vec3 normal, vec3 direction) {
    const float away = dot(normal, direction);
    if (away <= 0.0) return normal;
    return away < SILHOUETTE_BEND ? normalize(normal - away * direction) : -normal;
}

// A gathered normal.
vec3 facing_normal(vec3 gathered, vec3 direction) {
    const float size = length(gathered);
    if (size < 1e-6) return -direction;
    return turned_to_viewer(gathered / size, direction);
}
vec3 facing_normal(RayState state, vec3 direction) { return facing_normal(state.normal_depth.xyz, direction); }

// What a surface of base colour 1 sends to the viewer.
vec3 light_on(vec3 point, vec3 normal, float visibility) {
    const float facing = max(dot(normal, direction_to_light(point)), 0.0);
    const float sky = view.light_color.w * (0.75 + 0.25 * normal.y);
    return view.light_color.rgb * (sky + (1.0 - view.light_color.w) * facing * visibility);
}

vec3 light_on_voxels(RayState state, PixelRay seen, float visibility) {
    const vec3 normal = facing_normal(state, seen.direction);
    return light_on(seen.origin + seen.direction * state.normal_depth.w, normal, visibility);
}

void store_pixel(ivec2 pixel, vec3 color, float alpha) {
    image_rgba8[pixel.y * view.size_shadow.x + pixel.x] = packUnorm4x8(vec4(srgb_from_linear(color), alpha));
}

// Is the share of the light to be shown, and no colour?
bool shows_light() { return view.band.z == SHOW_LIGHT; }

void store_light(ivec2 pixel, float share) {
    image_rgba8[pixel.y * view.size_shadow.x + pixel.x] = floatBitsToUint(share);
}

// What arrives of the light at a surface, which may turn its back to it.
float light_at(vec3 point, vec3 normal, float visibility) {
    return dot(normal, direction_to_light(point)) > 0.0 ? visibility : 0.0;
}

float light_at_voxels(RayState state, PixelRay seen, float visibility) {
    return light_at(seen.origin + seen.direction * state.normal_depth.w, facing_normal(state, seen.direction), visibility);
}

void write_pixel(ivec2 pixel, RayState state, float visibility) {
    const float alpha = 1.0 - state.color.a;
    if (shows_light()) {
        store_light(pixel, alpha > 0.0 ? light_at_voxels(state, pixel_ray(pixel), visibility) : SHOWN_NOTHING);
        return;
    }
    uint encoded = uint(view.band.w);
    if (alpha > 0.0) {
        const vec3 light = light_on_voxels(state, pixel_ray(pixel), visibility);
        const vec3 color = state.color.rgb * light + state.color.a * view.background.rgb;
        encoded = packUnorm4x8(vec4(srgb_from_linear(color), alpha));
    }
    image_rgba8[pixel.y * view.size_shadow.x + pixel.x] = encoded;
}

#ifdef WITH_MESHES
#include "mesh/mesh_surface.glsl"

vec3 mesh_point(MeshPixel mesh, PixelRay seen) { return seen.origin + seen.direction * mesh.t; }

// The interpolated normal, on the side of the triangle that is seen. At a silhouette it may look away all the same.
vec3 mesh_normal(MeshPixel mesh, PixelRay seen) {
    const vec3 normal = dot(mesh.normal, mesh.plane) < 0.0 ? -mesh.normal : mesh.normal;
    return normalize(normal - max(dot(normal, seen.direction), 0.0) * seen.direction);
}

// Is there light to be stopped on its way to the mesh, and does anyone see it?
bool mesh_needs_shadow_ray(MeshPixel mesh, PixelRay seen, float transmittance) {
    if (!mesh_shadows || view.size_shadow.z == 0 || !is_there(mesh) || transmittance < OPAQUE_TRANSMITTANCE) return false;
    // Shading looks at the interpolated normal; whether light arrives is told by the triangle.
    const vec3 normal = shows_light() ? mesh.plane : mesh_normal(mesh, seen);
    return dot(normal, direction_to_light(mesh_point(mesh, seen))) > 0.0;
}

// What stands behind the voxels: the mesh, or the background, whose alpha is 0.
vec4 lit_mesh(MeshPixel mesh, PixelRay seen, float mesh_visibility) {
    if (!is_there(mesh)) return vec4(view.background.rgb, 0.0);
    const vec3 normal = mesh_normal(mesh, seen);
    return vec4(mesh.color * light_on(mesh_point(mesh, seen), normal, mesh_visibility), 1.0);
}

void write_pixel(ivec2 pixel, RayState state, float visibility, MeshPixel mesh, float mesh_visibility) {
    const PixelRay seen = pixel_ray(pixel);
    if (shows_light()) {
        const float on_mesh = light_at(mesh_point(mesh, seen), mesh.plane, mesh_visibility);
        const float on_voxels = light_at_voxels(state, seen, visibility);
        if (is_there(mesh)) {
            store_light(pixel, mix(on_voxels, on_mesh, state.color.a));
        } else {
            store_light(pixel, state.color.a < 1.0 ? on_voxels : SHOWN_NOTHING);
        }
        return;
    }
    vec4 color = state.color.a * lit_mesh(mesh, seen, mesh_visibility);
    const float alpha = 1.0 - state.color.a;
    if (alpha > 0.0) color += vec4(state.color.rgb * light_on_voxels(state, seen, visibility), alpha);
    store_pixel(pixel, color.rgb, color.a);
}
#endif

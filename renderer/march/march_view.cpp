#include "renderer/march/march_view.h"

#include <cmath>

#include "base/error.h"
#include "shaders/interop/shadow_rays.h"

namespace cairn::renderer {

TilePoint tile_point(const View& view, const glm::dvec3& point, const voxelizer::Grid& grid) {
    if (view.anchor) return {*view.anchor, point};
    return {Tile{}, (point - grid.origin) / (grid.voxel_size * grid.resolution.x)};
}

namespace {

/// The view without its anchor, for trees so shallow that doubles hold all positions.
View in_world(const View& view, const voxelizer::Grid& grid, const TreeShape& shape) {
    if (!view.anchor) return view;
    View out = view;
    const double side = grid.voxel_size * grid.resolution.x;
    const double across = std::ldexp(1.0, shape.n_shift() * view.anchor->level);
    auto to_world = [&](const glm::dvec3& place) {
        return grid.origin + (glm::dvec3(view.anchor->position) + place) * (side / across);
    };
    out.camera.eye = to_world(view.camera.eye);
    out.camera.target = to_world(view.camera.target);
    out.light.position = to_world(view.light.position);
    out.light.radius *= side / across;
    out.light.half_u *= side / across;
    out.light.half_v *= side / across;
    out.anchor.reset();
    return out;
}

static_assert(int(optics::LightShape::sphere) == LIGHT_SPHERE &&
              int(optics::LightShape::rectangle) == LIGHT_RECTANGLE &&
              int(optics::LightShape::disk) == LIGHT_DISK);

/// @param voxel_size  side of the voxels that are the unit of `out`, in units of the view's light.
void set_area_light(interop::MarchView& out, const View& view, double voxel_size) {
    const optics::Light& light = view.light;
    const double lost = 2.0 * std::pow(std::sin(0.5 * light.angle), 2.0);
    out.light_half_u = glm::vec3(light.half_u / voxel_size);
    out.light_half_v = glm::vec3(light.half_v / voxel_size);
    out.light_radius = float(light.radius / voxel_size);
    out.light_cosine_loss = float(lost);
    const optics::LightShape shape = light.positional ? light.shape : optics::LightShape::sphere;
    const bool soft = is_soft(view);
    out.light_shape = int(shape);
    out.shadow_rays = shadow_samples(view);
    out.is_soft = soft ? 1 : 0;
    out.is_cones = soft && view.shadow.kind == ShadowQuality::Kind::cones ? 1 : 0;
}

/// The positions of a view, in voxels: of the finest level, from the low corner of the root cube; or of the
/// coarsest window, from the low corner of that window.
struct ViewPlaces {
    glm::dvec3 eye{0.0};
    glm::dvec3 light{0.0};   ///< position of a positional light
    glm::dvec3 centre{0.0};  ///< centre of the root cube
    double side = 0.0;       ///< side of the root cube
    double voxel = 1.0;      ///< side of a voxel, in the view's unit of length
};

ViewPlaces in_voxels(const View& view, const voxelizer::Grid& grid) {
    auto place = [&](const glm::dvec3& world) { return (world - grid.origin) / grid.voxel_size; };
    const double side = grid.resolution.x;
    return {place(view.camera.eye), place(view.light.position), glm::dvec3(0.5 * side), side,
            grid.voxel_size};
}

ViewPlaces in_window(const View& view, const voxelizer::Grid& grid, const TreeShape& shape,
                     const Window& window) {
    auto place = [&](const TilePoint& point) { return point_in_window(window, shape, point); };
    const glm::dvec3 low = place({Tile{}, glm::dvec3(0.0)});
    const glm::dvec3 high = place({Tile{}, glm::dvec3(1.0)});
    const double unit = view.anchor ? std::ldexp(1.0, -shape.n_shift() * view.anchor->level)
                                    : 1.0 / (grid.voxel_size * grid.resolution.x);
    return {place(tile_point(view, view.camera.eye, grid)),
            place(tile_point(view, view.light.position, grid)), 0.5 * (low + high), high.x - low.x,
            1.0 / ((high.x - low.x) * unit)};
}

interop::MarchView march_view(const View& view, const ViewPlaces& places, int n) {
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double half_height = std::tan(0.5 * view.camera.yfov);
    const double half_width = half_height * view.size.width / view.size.height;

    // Levels are n apart: the nearest one, as in mip mapping, has voxels between 1 / sqrt(n) and sqrt(n)
    // pixels.
    const double cone = 2.0 * half_height / view.size.height * view.detail.pixel_error * std::sqrt(double(n));

    // Far from the scene a float's step is many voxels: then rays start near the root cube, from the plane
    // that the eye moved forward lies in.
    const glm::dvec3& eye = places.eye;
    const double distance = glm::dot(places.centre - eye, forward);
    const double skipped = distance > 3.0 * places.side ? distance - 2.0 * places.side : 0.0;

    interop::MarchView out{};
    out.eye = glm::vec3(eye + forward * skipped);
    out.pixel_cone = float(cone);
    out.forward = glm::vec3(forward);
    out.skipped = float(skipped);
    out.right = glm::vec3(right * half_width);
    out.up = glm::vec3(up * half_height);
    out.width = view.size.width;
    out.height = view.size.height;
    out.row_count = view.size.height;
    out.light = glm::vec3(view.light.positional ? places.light : glm::normalize(view.light.towards));
    out.light_is_positional = view.light.positional ? 1 : 0;
    out.light_color = view.light.color;
    out.ambient = view.light.ambient;
    out.background = view.background;
    out.background_pixel = background_pixel(view.background);
    out.shown = int(view.show);
    out.casts_shadows = view.shadow.kind == ShadowQuality::Kind::none ? 0 : 1;
    out.shadow_cone_scale = float(view.shadow.pixel_error);
    out.pixel_x = float(view.pixel_place.x);
    out.pixel_y = float(view.pixel_place.y);
    set_area_light(out, view, places.voxel);
    const auto finite = [](const glm::vec3& v, float scalar) {
        return std::isfinite((v.x + v.y) + (v.z + scalar));
    };
    if (!finite(out.eye, out.pixel_cone) || !finite(out.forward, out.skipped) || !finite(out.light, 0.0F)) {
        throw Error(Fault::usage, "view", "the camera or the light is too far away for a float to hold",
                    "bring it nearer to the scene");
    }
    return out;
}

}  // namespace

interop::MarchView march_view(const View& view, const voxelizer::Grid& grid, const TreeShape& shape,
                              const Window* coarsest) {
    if (coarsest != nullptr) return march_view(view, in_window(view, grid, shape, *coarsest), shape.n);
    const View unanchored = in_world(view, grid, shape);
    return march_view(unanchored, in_voxels(unanchored, grid), shape.n);
}

interop::MarchView march_view(const View& view, const voxelizer::Grid& grid) {
    return march_view(view, in_voxels(view, grid), 1);
}

}  // namespace cairn::renderer

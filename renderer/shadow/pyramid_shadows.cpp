#include "renderer/shadow/pyramid_shadows.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "renderer/march/march_view.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/shadow/column_pyramid.h"
#include "renderer/shadow/column_shadows.h"
#include "renderer/shadow/shadow_checks.h"
#include "shaders/interop/march.h"
#include "shaders/interop/mesh.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/moving_surface.h"

namespace cairn::renderer {
namespace {

void check_pyramid_view(const View& view) {
    check_shows_surface(view);
    if (view.shadow.kind == ShadowQuality::Kind::cones)
        throw Error(Fault::usage, "view", "cones need coarser voxels than a pyramid's rays meet",
                    "choose rays, or shadows by voxels");
}

}  // namespace

struct PyramidShadows::Impl {
    Impl(const voxelizer::Grid& shown_grid, const PyramidShadowOptions& options,
         const gl::ShaderSource& shaders)
        : grid(shown_grid),
          pyramid(options.resolution, shaders),
          shadows(pyramid, options.mask, shaders),
          voxelizer(shaders) {}

    [[nodiscard]] const voxelizer::GpuSurface& surface() const { return moving ? moving->surface() : *still; }
    void build_pyramid(ShadowTimes& times);
    [[nodiscard]] std::vector<std::uint32_t> light(const View& view, int shown, ShadowTimes& times);

    voxelizer::Grid grid;
    ColumnPyramid pyramid;
    ColumnShadows shadows;
    voxelizer::ConservativeVoxelizer voxelizer;
    std::optional<voxelizer::GpuSurface> still;
    std::optional<voxelizer::MovingSurface> moving;
    std::optional<MeshRaster> raster;
    bool raster_on_cpu = false;  ///< `raster` shows a surface that the CPU built for one moment
    bool is_built = false;       ///< `pyramid` is that of the surface at its moment
    double move_ms = 0.0;        ///< time of moves since the last picture
};

void PyramidShadows::Impl::build_pyramid(ShadowTimes& times) {
    if (is_built) return;
    const voxelizer::Region region{grid.level(), glm::ivec3(0), pyramid.grid_size()};
    pyramid.build(voxelizer.voxelize_on_gpu(surface(), region));
    times.voxelize_ms = voxelizer.last_milliseconds();
    times.pyramid_ms = pyramid.last_milliseconds();
    times.has_prepared = true;
    is_built = true;
}

/// @param shown  SHOW_SURFACE or SHOW_LIGHT
std::vector<std::uint32_t> PyramidShadows::Impl::light(const View& view, int shown, ShadowTimes& times) {
    interop::MarchView ray_view = march_view(view, grid);
    ray_view.shown = shown;
    ray_view.background_pixel = 0;
    std::vector<std::uint32_t> pixels;
    for (int row = 0; row < view.size.height; row += ray_view.row_count) {
        const auto drawing = Clock::now();
        const MeshSurface mesh = raster->draw_surface(ray_view, {grid.origin, grid.voxel_size}, row);
        glFinish();
        times.raster_ms += milliseconds_since(drawing);
        const int end = std::min(mesh.first_row + mesh.rows, view.size.height);
        ray_view.first_row = row;
        ray_view.row_count = end - row;
        const auto band = shadows.light(
            ray_view, pyramid, {mesh.first_row, mesh.nearest, mesh.surface, MESH_SELF_SHADOW_HEIGHT});
        pixels.insert(pixels.end(), band.begin(), band.end());
        times.trace_ms += shadows.last_milliseconds();
        times.passes += shadows.last_passes();
    }
    return pixels;
}

PyramidShadows::PyramidShadows(const ShadowScene& scene, const PyramidShadowOptions& options,
                               const gl::ShaderSource& shaders) {
    check_casts_and_receives_all(scene);
    const scenes::Bounds& bounds = scene.motion ? scene.motion->bounds : scene.snapshot.bounds;
    impl_ = std::make_unique<Impl>(voxelizer::grid_around(bounds, options.resolution), options, shaders);
    Impl& impl = *impl_;
    constexpr voxelizer::SurfaceOptions surface{.attributes = true};
    if (scene.motion) {
        impl.moving.emplace(scene.scene, scene.motion->when, impl.grid, surface, shaders);
        impl.raster_on_cpu = impl.moving->was_on_cpu();
    } else {
        impl.still =
            voxelizer::upload(voxelizer::build_surface(scene.scene, scene.snapshot, impl.grid, surface));
    }
    impl.raster.emplace(impl.surface(), impl.grid, shaders);
}
PyramidShadows::~PyramidShadows() = default;

void PyramidShadows::move_to(double seconds) {
    Impl& impl = *impl_;
    if (!impl.moving) ShadowRenderer::move_to(seconds);
    const auto start = Clock::now();
    impl.is_built = false;
    impl.moving->move_to(seconds);
    if (impl.moving->was_on_cpu() || impl.raster_on_cpu) {
        impl.raster->show(impl.surface());
        impl.raster_on_cpu = impl.moving->was_on_cpu();
    } else {
        impl.raster->surface_moved();
    }
    glFinish();
    impl.move_ms += milliseconds_since(start);
}

ShadowPicture PyramidShadows::render(const View& view, const ShadowRequest& request) {
    Impl& impl = *impl_;
    check_view(view);
    check_one_ray(view);
    check_pyramid_view(view);
    const auto start = Clock::now();
    ShadowPicture picture;
    ShadowTimes& times = picture.times;
    times.move_ms = impl.move_ms;
    times.pyramid_bytes = impl.pyramid.size_bytes();
    impl.build_pyramid(times);
    if (request.image) {
        const std::vector<std::uint32_t> pixels = impl.light(view, SHOW_SURFACE, times);
        picture.image = {view.size.width, view.size.height, std::vector<std::uint8_t>(4 * pixels.size())};
        std::memcpy(picture.image.rgba.data(), pixels.data(), picture.image.rgba.size());
    }
    if (request.light) {
        const std::vector<std::uint32_t> pixels = impl.light(view, SHOW_LIGHT, times);
        picture.light = {view.size.width, view.size.height, std::vector<float>(pixels.size())};
        std::memcpy(picture.light.shares.data(), pixels.data(), pixels.size() * sizeof(float));
    }
    times.shadow_ms = times.trace_ms;
    times.milliseconds = impl.move_ms + milliseconds_since(start);
    impl.move_ms = 0.0;
    return picture;
}

}  // namespace cairn::renderer

#include "renderer/pyramid_shadow.h"

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
#include "shaders/interop/march.h"
#include "shaders/interop/mesh.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/moving_surface.h"

namespace cairn::renderer {

struct PyramidShadowRenderer::Parts {
    Parts(const voxelizer::Grid& shown_grid, const PyramidShadowOptions& options,
          const gl::ShaderSource& shaders)
        : grid(shown_grid),
          pyramid(options.resolution, shaders),
          shadows(pyramid, options.mask, shaders),
          voxelizer(shaders) {
        statistics.pyramid_bytes = pyramid.size_bytes();
    }

    [[nodiscard]] const voxelizer::GpuSurface& surface() const { return moving ? moving->surface() : *still; }
    void build_pyramid();
    [[nodiscard]] std::vector<std::uint32_t> light(const View& view, int shown);

    voxelizer::Grid grid;
    ColumnPyramid pyramid;
    ColumnShadows shadows;
    voxelizer::ConservativeVoxelizer voxelizer;
    std::optional<voxelizer::GpuSurface> still;
    std::optional<voxelizer::MovingSurface> moving;
    std::optional<MeshRaster> raster;
    bool raster_on_cpu = false;  ///< it shows a surface that the CPU built for one moment
    bool is_built = false;       ///< the pyramid is that of the surface as it stands
    double move_ms = 0.0;        ///< since the last frame
    PyramidShadowStatistics statistics;
};

void PyramidShadowRenderer::Parts::build_pyramid() {
    if (is_built) return;
    const voxelizer::Region region{grid.level(), glm::ivec3(0), pyramid.grid_size()};
    pyramid.build(voxelizer.voxelize_on_gpu(surface(), region));
    statistics.voxelize_ms = voxelizer.last_milliseconds();
    statistics.pyramid_ms = pyramid.last_milliseconds();
    is_built = true;
}

/// @param shown  SHOW_SURFACE or SHOW_LIGHT
std::vector<std::uint32_t> PyramidShadowRenderer::Parts::light(const View& view, int shown) {
    check_view(view);
    const auto start = Clock::now();
    statistics = {.move_ms = move_ms, .pyramid_bytes = pyramid.size_bytes()};
    build_pyramid();
    interop::MarchView marched = march_view(view, grid);
    marched.shown = shown;
    marched.background_pixel = 0;
    std::vector<std::uint32_t> pixels;
    for (int row = 0; row < view.height; row += marched.row_count) {
        const auto drawing = Clock::now();
        const MeshSurface mesh = raster->draw_surface(marched, {grid.origin, grid.voxel_size}, row);
        glFinish();
        statistics.raster_ms += milliseconds_since(drawing);
        const int end = std::min(mesh.first_row + mesh.rows, view.height);
        marched.first_row = row;
        marched.row_count = end - row;
        const auto band =
            shadows.light(marched, pyramid, {mesh.first_row, mesh.nearest, mesh.surface, MESH_OWN_HEIGHT});
        pixels.insert(pixels.end(), band.begin(), band.end());
        statistics.trace_ms += shadows.last_milliseconds();
        statistics.passes += shadows.last_passes();
    }
    statistics.milliseconds = move_ms + milliseconds_since(start);
    move_ms = 0.0;
    return pixels;
}

PyramidShadowRenderer::PyramidShadowRenderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                             const PyramidShadowOptions& options,
                                             const gl::ShaderSource& shaders)
    : parts_(std::make_unique<Parts>(voxelizer::grid_around(snapshot.bounds, options.resolution), options,
                                     shaders)) {
    parts_->still =
        voxelizer::upload(voxelizer::build_surface(scene, snapshot, parts_->grid, {.attributes = true}));
    parts_->raster.emplace(*parts_->still, parts_->grid, shaders);
}

PyramidShadowRenderer::PyramidShadowRenderer(const scenes::Scene& scene, const scenes::When& when,
                                             const scenes::Bounds& bounds,
                                             const PyramidShadowOptions& options,
                                             const gl::ShaderSource& shaders)
    : parts_(std::make_unique<Parts>(voxelizer::grid_around(bounds, options.resolution), options, shaders)) {
    parts_->moving.emplace(scene, when, parts_->grid, voxelizer::SurfaceOptions{.attributes = true}, shaders);
    parts_->raster.emplace(parts_->surface(), parts_->grid, shaders);
    parts_->raster_on_cpu = parts_->moving->was_on_cpu();
}

PyramidShadowRenderer::PyramidShadowRenderer(PyramidShadowRenderer&&) noexcept = default;
PyramidShadowRenderer& PyramidShadowRenderer::operator=(PyramidShadowRenderer&&) noexcept = default;
PyramidShadowRenderer::~PyramidShadowRenderer() = default;

void PyramidShadowRenderer::move_to(double seconds) {
    Parts& parts = *parts_;
    if (!parts.moving)
        throw Error(Fault::usage, "moving scene", "the renderer was made for one moment",
                    "make it for a scene and the bounds of its animation");
    const auto start = Clock::now();
    parts.is_built = false;
    parts.moving->move_to(seconds);
    if (parts.moving->was_on_cpu() || parts.raster_on_cpu) {
        parts.raster->show(parts.surface());
        parts.raster_on_cpu = parts.moving->was_on_cpu();
    } else {
        parts.raster->surface_moved();
    }
    glFinish();
    parts.move_ms += milliseconds_since(start);
}

optics::Image PyramidShadowRenderer::render(const View& view) {
    const std::vector<std::uint32_t> pixels = parts_->light(view, SHOW_SURFACE);
    optics::Image image{view.width, view.height, std::vector<std::uint8_t>(4 * pixels.size())};
    std::memcpy(image.rgba.data(), pixels.data(), image.rgba.size());
    return image;
}

optics::LightShares PyramidShadowRenderer::light_shares(const View& view) {
    const std::vector<std::uint32_t> pixels = parts_->light(view, SHOW_LIGHT);
    optics::LightShares out{view.width, view.height, std::vector<float>(pixels.size())};
    std::memcpy(out.shares.data(), pixels.data(), pixels.size() * sizeof(float));
    return out;
}

const PyramidShadowStatistics& PyramidShadowRenderer::statistics() const {
    return parts_->statistics;
}

}  // namespace cairn::renderer

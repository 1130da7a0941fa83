#include "renderer/frame/band.h"

#include <algorithm>

#include "base/error.h"
#include "renderer/march/march_view.h"
#include "renderer/mesh/mesh_raster.h"
#include "shaders/interop/mesh.h"

namespace cairn::renderer {

Band make_band(const View& view, Content& content, const TreeShape& shape) {
    Band band;
    band.is_blended = view.detail.kind == LevelOfDetail::Kind::blended;
    if (band.is_blended && shape.mips == 0) {
        throw Error(Fault::usage, "view", "levels of detail cannot be blended without mip levels",
                    "make the content a surface, with TreeOptions::mips");
    }
    const voxelizer::Grid& grid = content.grid();
    const TilePoint eye = tile_point(view, view.camera.eye, grid);
    if (shape.has_windows()) {
        band.windows = windows_around(shape, eye);
        drop_empty(band.windows, shape, content.oracle());
    }
    band.view = march_view(view, grid, shape, band.windows.empty() ? nullptr : &band.windows.back());
    band.view.surface_color = content.uniform_color();
    if (band.windows.empty()) return band;
    const TilePoint light = tile_point(view, view.light.position, grid);
    band.ray_windows = make_ray_windows(band.windows, shape, eye, view.light.positional ? &light : nullptr,
                                        view.light.towards);
    band.ray_windows.back().eye = band.view.eye;  // nearer to the scene, where the eye is far from it
    return band;
}

void set_rows(Band& band, Rows rows, int shown, std::uint32_t background) {
    band.view.first_row = rows.first;
    band.view.row_count = rows.count;
    band.view.shown = shown;
    band.view.background_pixel = background;
}

int draw_mix(Band& band, const Mix& mix, const voxelizer::Grid& grid, int row) {
    const ViewSpace space{grid.origin, grid.voxel_size};
    int end = band.view.height;
    band.mix = MixTextures{};
    if (mix.meshes != nullptr) {
        const MeshSurface mesh = mix.meshes->draw_surface(band.view, space, row);
        band.mix.mesh_nearest = mesh.nearest;
        band.mix.mesh_surface = mesh.surface;
        band.mix.mesh_first_row = mesh.first_row;
        band.mix.mesh_shadows = mix.mesh_shadows;
        band.mix.voxels_hidden = mix.voxels_hidden;
        band.mix.mesh_self_shadow_height = mix.meshes_are_voxelized ? MESH_SELF_SHADOW_HEIGHT : 0.0F;
        end = std::min(end, mesh.first_row + mesh.rows);
    }
    if (mix.proxy != nullptr) {
        const MeshSpan span = mix.proxy->draw_span(band.view, space, row);
        band.mix.proxy_span = span.span;
        band.mix.proxy_faces = span.faces;
        band.mix.proxy_first_row = span.first_row;
        end = std::min(end, span.first_row + span.rows);
    }
    return end;
}

}  // namespace cairn::renderer

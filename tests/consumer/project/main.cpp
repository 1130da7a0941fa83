// Voxelizes and renders a built-in scene with the installed libraries alone, beside a loader and a header of
// the same names of its own. Exits 0 if both show something.

#include <algorithm>
#include <cstdio>
#include <memory>

#include <base/error.h>
#include <cairn/base/error.h>
#include <cairn/gl/context.h>
#include <cairn/optics/camera.h>
#include <cairn/renderer/open_content.h>
#include <cairn/renderer/renderer.h>
#include <cairn/scenes/load.h>
#include <cairn/scenes/snapshot.h>
#include <cairn/version.h>
#include <cairn/voxelizer/methods/voxelizer.h>
#include <cairn/voxelizer/surface/surface.h>
#include <glad/gl.h>

#if !defined(CONSUMER_BASE_ERROR) || CAIRN_VERSION_MAJOR != 0 || CAIRN_VERSION_MINOR < 2
#error "a header of Cairn was found in the place of the consumer's, or its version is wrong"
#endif

int main() {
    try {
        if (gladLoadGL(nullptr) != 0 || glad_glUseProgram != nullptr || GLAD_GL_VERSION_4_5 != 0) return 1;
        const std::unique_ptr<cairn::gl::Context> context = cairn::gl::create_context();
        if (glad_glUseProgram != nullptr || GLAD_GL_VERSION_4_5 != 0) return 1;  // the loaders are two
        const cairn::scenes::Scene scene = cairn::scenes::make_builtin("cornell");
        const cairn::scenes::Snapshot snapshot = cairn::scenes::take_snapshot(scene);

        const cairn::voxelizer::Grid grid = cairn::voxelizer::grid_around(snapshot.bounds, 32);
        const cairn::voxelizer::GpuSurface surface =
            cairn::voxelizer::upload(cairn::voxelizer::build_surface(scene, snapshot, grid));
        const auto voxelizer = cairn::voxelizer::make_voxelizer(cairn::voxelizer::Method::conservative);
        const auto occupied = voxelizer->voxelize(surface, cairn::voxelizer::whole(grid)).count();

        cairn::renderer::View view;
        view.size = {64, 48};
        view.camera = cairn::optics::framing_camera(snapshot.bounds, view.size.aspect());
        cairn::renderer::Renderer renderer(cairn::renderer::surface_content(scene, snapshot));
        const cairn::optics::Image image = renderer.render(view).image;
        // The same scene as triangles has a picture of its own.
        renderer.set_mix(
            {.meshes = cairn::renderer::make_mesh_raster(scene, snapshot), .voxels_hidden = true});
        const cairn::optics::Image triangles = renderer.render(view).image;
        const auto [low, high] = std::minmax_element(image.rgba.begin(), image.rgba.end());

        std::printf("Cairn %s: %llu voxels, pixels from %d to %d\n", CAIRN_VERSION,
                    static_cast<unsigned long long>(occupied), *low, *high);
        return occupied != 0 && *low != *high && triangles.rgba != image.rgba ? 0 : 1;
    } catch (const cairn::Error& error) {
        std::fprintf(stderr, "%s\n  %s\n", error.what(), error.way_out().c_str());
        return 1;
    }
}

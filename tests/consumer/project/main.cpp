// Voxelizes and renders a built-in scene with the installed libraries alone. Exits 0 when both show
// something.

#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "gl/context.h"
#include "renderer/renderer.h"
#include "scenes/builtin/builtin.h"
#include "scenes/snapshot.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/surface.h"

int main() {
    try {
        const std::unique_ptr<cairn::gl::Context> context = cairn::gl::create_context();
        const cairn::scenes::Scene scene = cairn::scenes::make_builtin("cornell");
        const cairn::scenes::Snapshot snapshot = cairn::scenes::take_snapshot(scene);

        const cairn::voxelizer::Grid grid = cairn::voxelizer::grid_around(snapshot.bounds, 32);
        const cairn::voxelizer::GpuSurface surface =
            cairn::voxelizer::upload(cairn::voxelizer::build_surface(scene, snapshot, grid));
        cairn::voxelizer::ConservativeVoxelizer voxelizer;
        const auto occupied = voxelizer.voxelize(surface, cairn::voxelizer::whole(grid)).count();

        cairn::renderer::View view;
        view.width = 64;
        view.height = 48;
        view.camera = optics::framing_camera(snapshot.bounds, 64.0 / 48.0);
        const optics::Image image = cairn::renderer::Renderer(scene, snapshot).render(view);
        const auto [low, high] = std::minmax_element(image.rgba.begin(), image.rgba.end());

        std::printf("%llu voxels, pixels from %d to %d\n", static_cast<unsigned long long>(occupied), *low,
                    *high);
        return occupied != 0 && *low != *high ? 0 : 1;
    } catch (const cairn::Error& error) {
        std::fprintf(stderr, "%s\n  %s\n", error.what(), error.way_out().c_str());
        return 1;
    }
}

// voxelize_to_vdb SCENE RESOLUTION OUTPUT.vdb: the voxels that a scene's surface touches, for OpenVDB. Runs
// in bounded memory, so that the grid may be larger than memory.

#include <cstdio>
#include <cstdlib>

#include <cairn/base/error.h>
#include <cairn/gl/context.h>
#include <cairn/scenes/load.h>
#include <cairn/scenes/snapshot.h>
#include <cairn/voxelizer/files/voxel_writer.h>
#include <cairn/voxelizer/methods/voxelize_tiles.h>

namespace voxelizer = cairn::voxelizer;

int main(int argc, char** argv) try {
    if (argc != 4) {
        std::fprintf(stderr, "usage: %s SCENE RESOLUTION OUTPUT.vdb\n", argv[0]);
        return 2;
    }
    const auto context = cairn::gl::create_context();
    const cairn::scenes::Scene scene = cairn::scenes::load(argv[1]);
    const cairn::scenes::Snapshot snapshot = cairn::scenes::take_snapshot(scene);
    const voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, std::atoi(argv[2]));

    // The triangles on the grid's lattice, their copy on the GPU, and an index of those that each part of the
    // grid may touch.
    const voxelizer::Surface surface = voxelizer::build_surface(scene, snapshot, grid);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    voxelizer::TriangleIndex index(surface);

    const auto exact = voxelizer::make_voxelizer(voxelizer::Method::conservative);
    const auto writer = voxelizer::make_voxel_writer(argv[3], grid);
    const voxelizer::TileStatistics statistics = voxelizer::voxelize_tiles(
        *exact, on_gpu, index, grid, [&](const voxelizer::VoxelTile& tile) { writer->add(tile); });
    writer->finish();  // the file appears here
    std::printf("%llu voxels\n", static_cast<unsigned long long>(statistics.occupied));
    return 0;
} catch (const cairn::Error& error) {
    std::fprintf(stderr, "%s\n  %s\n", error.what(), error.way_out().c_str());
    return 1;
}

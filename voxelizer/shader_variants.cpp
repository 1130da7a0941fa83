#include "voxelizer/shader_variants.h"

#include "voxelizer/methods/raster_voxelizer.h"

namespace cairn::voxelizer {

std::vector<gl::ShaderVariants> shader_variants() {
    std::vector<gl::Defines> raster;
    for (const RasterVariant& variant : valid_raster_variants())
        raster.push_back(defines(variant));
    return {
        {"voxelize/decide_masked.comp.glsl"},
        {"voxelize/deform.comp.glsl", gl::each_value("NORMALS", {0, 1})},
        {"voxelize/feed.vert.glsl", raster},
        {"voxelize/find_far.comp.glsl"},
        {"voxelize/gather_attributes.comp.glsl", gl::each_value("HAS_MASK", {0, 1})},
        {"voxelize/halve.comp.glsl", gl::each_value("WIDE", {0, 1})},
        {"voxelize/list_masked.comp.glsl"},
        {"voxelize/list_pairs.comp.glsl", gl::each_value("LARGE", {0, 1})},
        {"voxelize/list_primitives.comp.glsl"},
        {"voxelize/mark_large.comp.glsl"},
        {"voxelize/mark_small.comp.glsl", gl::each_value("EXACT", {0, 1})},
        {"voxelize/project.geom.glsl", raster},
        {"voxelize/project.vert.glsl", raster},
        {"voxelize/slice.frag.glsl", raster},
        {"voxelize/unite_slices.comp.glsl", gl::each_value("ALONG_X", {0, 1})},
    };
}

}  // namespace cairn::voxelizer

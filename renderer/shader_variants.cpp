#include "renderer/shader_variants.h"

#include <map>
#include <string>
#include <utility>

#include "renderer/shadow/column_shadows.h"
#include "shaders/interop/columns.h"

namespace cairn::renderer {
namespace {

gl::Defines joined(gl::Defines first, const gl::Defines& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

ContentProgram volume(int steps, bool has_constant) {
    return {.primary = "march/volume.comp.glsl",
            .shadow = "march/volume_shadow.comp.glsl",
            .volume_steps = steps,
            .has_constant = has_constant};
}

std::vector<gl::ShaderVariants> of_marcher() {
    std::map<std::string, std::vector<gl::Defines>> by_name;
    for (const MarchSetting& setting : march_settings()) {
        for (const RayKind rays : {RayKind::primary, RayKind::shadow}) {
            const bool is_primary = rays == RayKind::primary;
            auto& sets = by_name[is_primary ? setting.content.primary : setting.content.shadow];
            for (const MarchVariant& variant : valid_variants(rays, setting))
                sets.push_back(joined(defines(setting), defines(variant)));
        }
    }
    std::vector<gl::ShaderVariants> out = {{"march/tile_blocks.comp.glsl"}};
    for (auto& [name, sets] : by_name)
        out.push_back({name, std::move(sets)});
    return out;
}

std::vector<gl::ShaderVariants> of_producers() {
    std::vector<gl::Defines> fractal;
    for (const TreeShape& shape : {TreeShape{4, 16}, TreeShape{2, 8}, TreeShape{3, 27}})
        fractal.push_back(shape.defines(false));
    std::vector<gl::Defines> surface;
    TreeShape with_marks{2, 8, 7, 1};
    with_marks.geometry = VoxelGeometry::marks;
    TreeShape with_slabs{8, 8, 3, 3};
    with_slabs.geometry = VoxelGeometry::slabs;
    for (const TreeShape& shape : {TreeShape{4, 16, 4, 2}, TreeShape{4, 16}, with_marks, with_slabs,
                                   TreeShape{3, 27}, TreeShape{3, 81}, TreeShape{2, 64}}) {
        for (const bool has_color : {false, true}) {
            for (const gl::Defines& mask : gl::each_value("HAS_MASK", {0, 1}))
                surface.push_back(joined(shape.defines(has_color), mask));
        }
    }
    return {{"produce/fractal.comp.glsl", fractal},       {"produce/fractal_masks.comp.glsl", fractal},
            {"produce/masks.comp.glsl", surface},         {"produce/border_masks.comp.glsl", surface},
            {"produce/count_records.comp.glsl", surface}, {"produce/normals.comp.glsl", surface},
            {"produce/slabs.comp.glsl", surface},         {"produce/flat_voxels.comp.glsl", surface},
            {"produce/count_marks.comp.glsl", surface},   {"produce/store_heads.comp.glsl", surface},
            {"produce/resolve.comp.glsl", surface},       {"produce/splat.comp.glsl", surface},
            {"produce/summarize.comp.glsl", surface}};
}

std::vector<gl::ShaderVariants> of_meshes() {
    const std::vector<gl::Defines> masked = gl::each_value("MASKED", {0, 1});
    return {{"mesh/draw_surface.frag.glsl", masked},
            {"mesh/find_nearest.frag.glsl", masked},
            {"mesh/find_span.frag.glsl", masked},
            {"mesh/place_triangles.comp.glsl"},
            {"mesh/project.vert.glsl", masked}};
}

std::vector<gl::ShaderVariants> of_shadows() {
    const std::vector<gl::Defines> levels =
        gl::each_value("COLUMN_LEVELS", {COLUMN_LEAST_LEVELS, 9, COLUMN_MOST_LEVELS});
    std::vector<gl::Defines> columns;
    for (const gl::Defines& level : levels) {
        for (const ColumnMask mask : {ColumnMask::mip_level, ColumnMask::adaptive}) {
            for (const bool is_soft : {false, true})
                columns.push_back(joined(level, defines(ColumnVariant{mask, is_soft})));
        }
    }
    return {{"shadow/add_batch.frag.glsl"},
            {"shadow/cover_map.vert.glsl"},
            {"shadow/draw_lit.frag.glsl"},
            {"shadow/draw_lit.vert.glsl"},
            {"shadow/draw_map.frag.glsl"},
            {"shadow/draw_map.vert.glsl"},
            {"shadow/find_visible.comp.glsl", gl::each_value("SHADOW_PASSES", {1, 2})},
            {"shadow/halve_columns.comp.glsl", levels},
            {"shadow/hide_light.frag.glsl"},
            {"shadow/hide_light.vert.glsl"},
            {"shadow/light_columns.comp.glsl", columns},
            {"shadow/list_patches.comp.glsl", gl::each_value("LIST_WRITES", {0, 1})},
            {"shadow/reduce_receivers.comp.glsl", gl::each_value("REDUCE_BASE", {0, 1})}};
}

}  // namespace

std::vector<MarchSetting> march_settings() {
    const TreeShape in_windows = make_deep_tree_shape(2, 16, 40);
    const TreeShape wide_in_windows = make_deep_tree_shape(4, 16, 20);
    const Channels plain;
    const Channels color{.color = true};
    const Channels packed{.packed = true};
    const Channels packed_color{.color = true, .packed = true};
    TreeShape with_marks{2, 8, 7, 1};
    with_marks.geometry = VoxelGeometry::marks;
    TreeShape with_slabs{8, 8, 3, 3};
    with_slabs.geometry = VoxelGeometry::slabs;
    TreeShape of_voxels{4, 64, 0};
    of_voxels.geometry = VoxelGeometry::voxel;
    return {
        // n, m, levels and mips; channels; traversal; tile queries; content
        {{4, 16, 4, 2}, packed_color, Traversal::mini_stack},
        {{4, 16, 4}, packed, Traversal::mini_stack, TileQueries::blocks},
        {with_marks, packed, Traversal::stackless},
        {with_slabs, packed, Traversal::restart},
        {{8, 16, 3},
         color,
         Traversal::stackless,
         TileQueries::list,
         {.has_constant = true, .has_final = true}},
        {{2, 16, 8}, plain, Traversal::mini_stack, TileQueries::list, {.has_constant = true}},
        {{3, 27, 5}, packed_color, Traversal::stackless},
        {{3, 81, 4}, plain, Traversal::mini_stack},
        {of_voxels, packed, Traversal::mini_stack},
        {{2, 32, 5}, color, Traversal::restart},
        {in_windows, plain, Traversal::restart},
        {wide_in_windows, plain, Traversal::restart, TileQueries::blocks},
        {{4, 16, 4}, plain, Traversal::mini_stack, TileQueries::list, volume(2, false)},
        {{2, 8, 7}, plain, Traversal::stackless, TileQueries::list, volume(1, true)},
        {{4, 64, 0}, plain, Traversal::restart, TileQueries::list, volume(16, false)},
        {{3, 27, 4}, plain, Traversal::mini_stack, TileQueries::blocks, volume(2, true)},
    };
}

std::vector<gl::ShaderVariants> shader_variants() {
    std::vector<gl::ShaderVariants> all = of_marcher();
    for (const auto& more : {of_producers(), of_meshes(), of_shadows()})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace cairn::renderer

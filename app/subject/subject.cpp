#include "app/subject/subject.h"

#include <algorithm>

#include "app/subject/fractal.h"
#include "app/subject/volume_input.h"
#include "app/terminal/progress.h"
#include "app/terminal/terminal.h"
#include "base/error.h"
#include "renderer/produce/fractal_content.h"

namespace cairn::app {

Subject::Subject(const SceneOptions& scene, const ViewOptions& options, bool quiet)
    : fractal_(is_fractal(scene)), sponge_(is_sponge(scene)) {
    if (options.zoom != 0 && !fractal_) {
        throw Error(Fault::usage, "--zoom", "this scene has a finest level",
                    "use --camera, or builtin:fractal");
    }
    if (fractal_ || sponge_) return;
    if (!is_volume(scene.scene)) {
        if (options.transfer || options.copies != 1)
            throw Error(Fault::usage, options.transfer ? "--transfer" : "--copies", "the scene is no volume",
                        "it is for volumes only");
        scene_ = load_input(scene, quiet);
        return;
    }
    if (scene.seconds || scene.animation || scene.scene_index)
        throw Error(Fault::usage, scene.scene, "a volume has no moments and no scenes",
                    "leave out --time, --animation and --scene-index");
    const Progress progress("loading", quiet);
    VolumeInput input = load_volume_input(scene.scene, options.tree, options.copies);
    if (!quiet) {
        for (const std::string& warning : input.warnings)
            warn(warning);
    }
    field_ = std::move(input.field);
}

scenes::Bounds Subject::bounds() const {
    if (fractal_) return {glm::dvec3(-0.5), glm::dvec3(0.5)};
    if (sponge_) return {glm::dvec3(0.0), glm::dvec3(1.0)};
    return scene_ ? scene_->snapshot.bounds : bounds_of(*field_);
}

void Subject::add_figures(Report& report) const {
    if (scene_) {
        report.add("triangles", scene_->snapshot.triangle_count);
    } else if (field_) {
        report.add("voxels", json_of(field_->frame().size));
    }
}

renderer::View Subject::view(const ViewOptions& options) const {
    if (fractal_) return fractal_view(options, options.zoom);
    if (scene_) return view_of(options, scene_->snapshot);
    scenes::Snapshot only_bounds;
    only_bounds.bounds = bounds();
    return view_of(options, only_bounds);
}

renderer::Renderer Subject::make_renderer(const ViewOptions& options, const gl::ShaderSource& shaders) const {
    if (fractal_ || sponge_) {
        const renderer::TreeOptions tree = fractal_ ? fractal_tree(options) : sponge_tree(options);
        return {std::make_unique<renderer::FractalContent>(renderer::tree_shape_of(tree), shaders), tree,
                shaders};
    }
    if (scene_) return {scene_->scene, scene_->snapshot, options.tree, shaders};
    const TransferChoice transfer = options.transfer.value_or(parse_transfer(default_transfer));
    return {field_, transfer.for_voxels(field_->frame().voxel_size), options.tree, {}, shaders};
}

}  // namespace cairn::app

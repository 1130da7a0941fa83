#include "renderer/shadow_renderer.h"

#include <utility>

#include "base/error.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
#include "renderer/open_content.h"
#include "renderer/renderer.h"
#include "renderer/shadow/map_shadows.h"
#include "renderer/shadow/pyramid_shadows.h"
#include "renderer/shadow/shadow_checks.h"

namespace cairn::renderer {
namespace {

const ShadowScene& checked(const ShadowScene& scene) {
    check_casts_and_receives_all(scene);
    if (scene.motion)
        throw Error(Fault::usage, scene.scene.name, "the voxels of a tree are those of one moment",
                    "choose the pyramid or soft shadow maps, or make a renderer per moment");
    return scene;
}

/// Renderer with its voxels hidden behind the meshes that they are made of.
class VoxelShadows final : public ShadowRenderer {
public:
    VoxelShadows(const ShadowScene& scene, const ShadowOptions& options, const gl::ShaderSource& shaders)
        : renderer_(surface_content(checked(scene).scene, scene.snapshot, options.tree, shaders),
                    options.renderer, shaders) {
        renderer_.set_mix({.meshes = std::make_shared<MeshRaster>(scene.scene, scene.snapshot, shaders),
                           .mesh_shadows = true,
                           .meshes_are_voxelized = true,
                           .voxels_hidden = true});
    }

    ShadowPicture render(const View& view, const ShadowRequest& request) override {
        renderer_.forget_picture();
        ShadowPicture picture;
        if (request.image) {
            Frame frame = renderer_.render(view, {.progress = request.progress});
            picture.image = std::move(frame.image);
            add(frame.statistics, picture.times);
        }
        if (request.light) {
            LightFrame frame = renderer_.light(view, request.progress);
            picture.light = std::move(frame.light);
            add(frame.statistics, picture.times);
        }
        return picture;
    }

private:
    static void add(const FrameStatistics& frame, ShadowTimes& times) {
        times.milliseconds += frame.milliseconds;
        times.shadow_ms = frame.milliseconds;
        times.voxelize_ms += frame.produce_ms;
        times.trace_ms += frame.march_ms;
        times.passes += frame.passes;
        times.has_prepared = times.has_prepared || frame.bricks_produced + frame.nodes_subdivided > 0;
    }

    Renderer renderer_;
};

}  // namespace

std::unique_ptr<ShadowRenderer> make_shadow_renderer(ShadowMethod method, const ShadowScene& scene,
                                                     const ShadowOptions& options,
                                                     const gl::ShaderSource& shaders) {
    switch (method) {
        case ShadowMethod::voxel:
            return std::make_unique<VoxelShadows>(scene, options, shaders);
        case ShadowMethod::pyramid:
            return std::make_unique<PyramidShadows>(scene, options.pyramid, shaders);
        case ShadowMethod::soft_shadow_map:
            break;
    }
    return std::make_unique<MapShadows>(scene, options.map, shaders);
}

}  // namespace cairn::renderer

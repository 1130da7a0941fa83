#pragma once

#include <memory>

#include "gl/shader_source.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

class MeshRaster;

/// A scene as triangles on the GPU, for a Mix. Lines and points of the scene are not drawn. Needs a current
/// context.
[[nodiscard]] std::shared_ptr<MeshRaster> make_mesh_raster(const scenes::Scene& scene,
                                                           const scenes::Snapshot& snapshot,
                                                           const gl::ShaderSource& shaders = {});

/// What is drawn as triangles beside the voxels (renderer/mesh/mesh_raster.h), in the same world.
struct Mix {
    /// Meshes that are shown where they are nearer than the voxels, and through what the voxels leave
    /// uncovered; lit like voxels. A voxel, or mark, counts as nearer if the middle of the ray's way through
    /// it is.
    /// Meshes cast no shadows.
    std::shared_ptr<MeshRaster> meshes = nullptr;
    /// Voxels cast shadows on the meshes if the view has shadows.
    bool mesh_shadows = false;
    /// The meshes are (also) the voxelized scene. Then voxels that touch the triangle at a pixel stand for
    /// that triangle, and cast no shadow on it. If false, contact shadows begin at the triangle.
    bool meshes_are_voxelized = false;
    /// Only the meshes are shown; voxels only cast shadows (Forest et al. 2009, section 3.1).
    bool voxels_hidden = false;
    /// Proxy geometry (Crassin et al. 2008, section 5.4): rays run from its first to its last face, or from
    /// the eye if more of its faces turn their back to the eye than their front, as inside a closed mesh.
    /// Pixels that the proxy does not cover launch no ray. A voxel shows if the ray's way through it reaches
    /// into the proxy. Shadow rays ignore the proxy: voxels that it hides still cast shadows.
    std::shared_ptr<MeshRaster> proxy = nullptr;
};

}  // namespace cairn::renderer

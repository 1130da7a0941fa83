#pragma once

#include <memory>

namespace cairn::renderer {

class MeshRaster;

/// What is drawn as triangles beside the voxels (renderer/mesh/mesh_raster.h), in the same world.
struct Mix {
    /// Shown where it is nearer than the voxels, and through what they leave uncovered; lit like them. A
    /// voxel counts as nearer when the middle of the ray's way through it is. Meshes cast no shadows.
    std::shared_ptr<MeshRaster> meshes = nullptr;
    bool mesh_shadows = false;  ///< voxels cast shadows on the meshes, when the view has shadows
    /// The meshes are (also) the voxelized scene: then voxels that touch the triangle at a pixel are its own,
    /// and cast no shadow on it. Else contact shadows begin at the triangle.
    bool meshes_are_voxelized = false;
    /// Only the meshes are shown; voxels do no more than cast shadows (Forest et al. 2009, section 3.1).
    bool voxels_hidden = false;
    /// Rays run only from its first to its last face, or from the eye where more of its faces turn their back
    /// to the eye than their front (which is so inside a closed mesh). Pixels that it does not cover launch
    /// no ray. A voxel shows when the ray's way through it reaches into the proxy. Shadow rays do not know
    /// it: what it hides still casts shadows (Crassin et al. 2008, section 5.4).
    std::shared_ptr<MeshRaster> proxy = nullptr;
};

}  // namespace cairn::renderer

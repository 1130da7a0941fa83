#pragma once

#include "gl/buffer.h"
#include "gl/handle.h"
#include "renderer/produce/volume.h"

namespace cairn::renderer {

/// What the shaders of volumes read: the pre-integrated transfer function and the numbers of VolumeView.
class TransferTable {
public:
    /// @param voxel_size  side of the tree's finest voxels, world units.
    /// @throws Error (Fault::usage) if an option is out of range.
    TransferTable(const TransferFunction& function, const VolumeOptions& options, double voxel_size);
    void bind() const;

private:
    gl::TextureHandle table_;
    gl::Buffer view_;
};

}  // namespace cairn::renderer

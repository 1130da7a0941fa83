#pragma once

#include <vector>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "renderer/produce/volume.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// Rays that step through one 3D texture, half a voxel at a time, until less than 1% of the light gets
/// through. Crassin 2007, section 3.7.1, compares its tree with them.
class RegularGrid {
public:
    /// Uploads the field at its finest level: resolution^3 bytes.
    /// @param extinction  extinction of density 1, per world unit
    /// @throws Error (Fault::memory or Fault::context) if the driver does not take the texture.
    RegularGrid(const renderer::Field& field, double extinction);

    struct Result {
        double milliseconds = 0.0;  ///< time from an idle driver to an idle driver
        std::vector<float> alpha;   ///< opacity per pixel, row 0 at the top
    };
    [[nodiscard]] Result march(const renderer::View& view) const;

private:
    renderer::FieldFrame frame_;
    double extinction_;
    gl::TextureHandle densities_;
    gl::Program program_;
};

}  // namespace cairn::bench

#pragma once

#include <vector>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "renderer/produce/volume_field.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// Rays that step through one 3D texture, half a voxel at a time, until they let less than 1% of the light
/// through: what Crassin 2007, section 3.7.1, sets its tree against.
class RegularGrid {
public:
    /// Holds the field at its finest: resolution^3 bytes.
    /// @param extinction  of density 1, a world unit
    /// @throws Error (Fault::memory or Fault::context) when the driver does not take it.
    RegularGrid(const renderer::Field& field, double extinction);

    struct Result {
        double milliseconds = 0.0;  ///< from an idle driver to an idle driver
        std::vector<float> alpha;   ///< row after row, from the top
    };
    [[nodiscard]] Result march(const renderer::View& view) const;

private:
    renderer::FieldFrame frame_;
    double extinction_;
    gl::TextureHandle densities_;
    gl::Program program_;
};

}  // namespace cairn::bench

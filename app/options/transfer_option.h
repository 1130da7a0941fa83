#pragma once

#include <string>
#include <vector>

#include "renderer/produce/volume.h"

namespace cairn::app {

constexpr const char* default_transfer = "solid";

/// A transfer function as it is given on the command line. Extinctions are per voxel of the volume, so that
/// one text suits volumes of any size.
struct TransferChoice {
    std::string text;  ///< text that was given
    std::vector<renderer::ControlPoint> points;

    [[nodiscard]] renderer::TransferFunction for_voxels(double voxel_size) const;
};

/// The names that parse_transfer() accepts: "bone, haze, ...".
[[nodiscard]] std::string transfer_names();

/// A name, or points "DENSITY:R,G,B:EXTINCTION" with ";" between them; densities and colours in [0, 1].
/// @throws Error (Fault::usage) if the text is neither; the error repeats the text.
[[nodiscard]] TransferChoice parse_transfer(const std::string& text);

}  // namespace cairn::app

#pragma once

#include <vector>

#include "gl/shader_variants.h"
#include "renderer/march/march_programs.h"

namespace cairn::renderer {

/// Every entry point of the renderer's shaders, with the definitions that its programs are built with. Trees,
/// pyramids and steps per voxel are of many sizes: of those there are samples, among which each shape of a
/// tree and each feature of march_settings() occurs; of all else, everything.
[[nodiscard]] std::vector<gl::ShaderVariants> shader_variants();

/// Samples of what the programs of a marcher have in common.
[[nodiscard]] std::vector<MarchSetting> march_settings();

}  // namespace cairn::renderer

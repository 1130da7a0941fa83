#pragma once

#include <vector>

#include "gl/shader_variants.h"

namespace cairn::voxelizer {

/// Every entry point of the voxelizer's shaders, with all definitions that its programs are built with.
[[nodiscard]] std::vector<gl::ShaderVariants> shader_variants();

}  // namespace cairn::voxelizer

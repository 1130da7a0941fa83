#include "renderer/produce/surface_content.h"

#include "renderer/produce/tile_lists.h"

namespace cairn::renderer {

SurfaceContent::SurfaceContent(const TreeShape& shape, const voxelizer::Surface& surface,
                               const gl::ShaderSource& shaders)
    : shape_(shape),
      grid_(surface.grid),
      uniform_color_(surface.uniform_color),
      surface_(voxelizer::upload(surface)),
      lists_(tile_lists(shape, surface)),
      voxelizer_(shaders),
      oracle_(shape, surface_, voxelizer_, lists_),
      producer_(shape, surface_, lists_, shaders) {}

}  // namespace cairn::renderer

#pragma once

#include "gl/shader_source.h"
#include "renderer/produce/content.h"
#include "renderer/produce/surface_oracle.h"
#include "renderer/produce/surface_producer.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/surface.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::renderer {

/// The surface of a scene, voxelized tile by tile.
class SurfaceContent final : public Content {
public:
    /// The surface is not needed afterwards.
    SurfaceContent(const TreeShape& shape, const voxelizer::Surface& surface,
                   const gl::ShaderSource& shaders);

    [[nodiscard]] const TreeShape& shape() const override { return shape_; }
    [[nodiscard]] Oracle& oracle() override { return oracle_; }
    [[nodiscard]] Producer& producer() override { return producer_; }
    [[nodiscard]] const voxelizer::Grid& grid() const override { return grid_; }
    [[nodiscard]] bool has_color() const override { return surface_.has_color; }
    [[nodiscard]] Channels channels() const override { return {.color = has_color(), .packed = true}; }
    [[nodiscard]] bool fills_mips() const override { return true; }
    [[nodiscard]] glm::vec3 uniform_color() const override { return uniform_color_; }

private:
    TreeShape shape_;
    voxelizer::Grid grid_;
    glm::vec3 uniform_color_;
    voxelizer::GpuSurface surface_;
    voxelizer::TriangleIndex lists_;
    voxelizer::ConservativeVoxelizer voxelizer_;
    SurfaceOracle oracle_;
    SurfaceProducer producer_;
};

}  // namespace cairn::renderer

#pragma once

#include <glm/glm.hpp>

#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content_program.h"
#include "renderer/produce/oracle.h"
#include "renderer/produce/producer.h"
#include "voxelizer/grid.h"

namespace cairn::renderer {

/// What a tree shows: the cube that its root covers, who knows what is empty there, and who fills its bricks.
class Content {
public:
    Content() = default;
    Content(const Content&) = delete;
    Content& operator=(const Content&) = delete;
    Content(Content&&) = delete;
    Content& operator=(Content&&) = delete;
    virtual ~Content() = default;

    /// Of the tree that the content is made for.
    [[nodiscard]] virtual const TreeShape& shape() const = 0;
    [[nodiscard]] virtual Oracle& oracle() = 0;
    [[nodiscard]] virtual Producer& producer() = 0;
    /// As many voxels as the finest level of the tree has.
    [[nodiscard]] virtual const voxelizer::Grid& grid() const = 0;
    /// Do bricks hold colours? Else everything has uniform_color(), linear.
    [[nodiscard]] virtual bool has_color() const = 0;
    [[nodiscard]] virtual Channels channels() const { return {.color = has_color()}; }
    [[nodiscard]] virtual glm::vec3 uniform_color() const = 0;
    /// How rays see it: like a surface, unless it says otherwise.
    [[nodiscard]] virtual ContentProgram program() const { return {}; }
    /// Does the producer fill the mip levels of bricks (TreeShape::mips)?
    [[nodiscard]] virtual bool fills_mips() const { return false; }
    /// May the producer find tiles constant and not empty? Then the tree keeps their values, and rays march
    /// them.
    [[nodiscard]] virtual bool has_constant() const { return false; }
    /// May it find that nothing finer adds to a tile (Produced::low_frequency)? Then each tile is produced
    /// before it is subdivided, so that what a ray sees does not depend on what was looked at before.
    [[nodiscard]] virtual bool has_low_frequency() const { return false; }
};

}  // namespace cairn::renderer

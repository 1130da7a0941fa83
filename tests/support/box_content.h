#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/produce/content.h"
#include "renderer/renderer.h"

/// Simple content for what surfaces do not have: a solid box of thin fog, all of one colour, over a white
/// floor. Both end on the planes of the coarsest voxels, so that all levels show the same shape.
namespace cairn::test {

struct BoxOptions {
    int n = 4;
    /// The box spans [margin / n, 1 - margin / n] of the root cube along each axis.
    int margin = 1;
    /// Whether tiles are reported whose voxels are all alike, border included.
    bool constant = true;
    /// Whether tiles of level 1 and more in the low half along x are final.
    bool low_frequency = false;
};

class BoxContent final : public renderer::Content, public renderer::Oracle, public renderer::Producer {
public:
    BoxContent(const renderer::TreeShape& shape, const BoxOptions& options);

    [[nodiscard]] const renderer::TreeShape& shape() const override { return shape_; }
    [[nodiscard]] renderer::Oracle& oracle() override { return *this; }
    [[nodiscard]] renderer::Producer& producer() override { return *this; }
    [[nodiscard]] const voxelizer::Grid& grid() const override { return grid_; }
    [[nodiscard]] bool has_color() const override { return true; }
    [[nodiscard]] glm::vec3 uniform_color() const override { return glm::vec3(1.0F); }
    [[nodiscard]] bool has_constant() const override { return options_.constant; }
    [[nodiscard]] bool has_low_frequency() const override { return options_.low_frequency; }

    [[nodiscard]] glm::uvec2 child_mask(const renderer::Tile& tile) override;
    [[nodiscard]] bool is_empty(const renderer::Tile& tile) override;
    std::vector<renderer::ProducedTile> produce(std::span<const renderer::BrickRequest> requests,
                                                renderer::BrickPool& pool) override;

    /// All tiles that were ever produced, in order.
    [[nodiscard]] const std::vector<renderer::Tile>& produced() const { return produced_; }

    /// Texels of the box and of the floor: square roots of the colour times the coverage, and the coverage.
    static constexpr glm::u8vec4 fog{2, 1, 2, 2};
    static constexpr glm::u8vec4 floor{255, 255, 255, 255};

private:
    /// The content of voxel v of a level, by its centre; outside the root cube there is nothing.
    [[nodiscard]] glm::u8vec4 texel(const glm::i64vec3& v, int level) const;
    void write(const renderer::BrickPool& pool, int slot, const std::vector<glm::u8vec4>& texels) const;

    renderer::TreeShape shape_;
    BoxOptions options_;
    voxelizer::Grid grid_;
    std::vector<renderer::Tile> produced_;
};

}  // namespace cairn::test

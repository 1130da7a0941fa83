// own_producer OUTPUT.ppm: a picture of a formula. A custom producer fills the bricks that rays need; a
// custom oracle reports tiles that are empty, so that no bricks are produced for them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

#include <cairn/base/error.h>
#include <cairn/gl/context.h>
#include <cairn/optics/camera.h>
#include <cairn/renderer/pool/tree_shape.h>
#include <cairn/renderer/produce/content.h>
#include <cairn/renderer/produce/cpu_brick.h>
#include <cairn/renderer/renderer.h>

#include "image_file.h"

namespace renderer = cairn::renderer;

namespace {

/// A wall around the gyroid sin x cos y + sin y cos z + sin z cos x = 0, in a ball. World: the cube [0, 1]^3.
struct Gyroid {
    static constexpr double waves = 4.0 * 6.283185307179586;  // radians per world unit
    static constexpr double wall = 0.25;  // greatest absolute value of the formula in the wall
    static constexpr double radius = 0.48;

    static double value(const glm::dvec3& p) {
        const glm::dvec3 w = p * waves;
        return std::sin(w.x) * std::cos(w.y) + std::sin(w.y) * std::cos(w.z) + std::sin(w.z) * std::cos(w.x);
    }
    static double from_ball(const glm::dvec3& p) { return glm::length(p - 0.5) - radius; }
    static bool holds(const glm::dvec3& p) { return std::abs(value(p)) < wall && from_ball(p) < 0.0; }

    /// Points outwards: along the gradient, away from the middle of the wall; or out of the ball where that
    /// cuts.
    static glm::dvec3 normal(const glm::dvec3& p, double voxel) {
        if (from_ball(p) > -voxel) return glm::normalize(p - 0.5);
        const double step = 0.25 * voxel;
        const glm::dvec3 x(step, 0.0, 0.0);
        const glm::dvec3 y(0.0, step, 0.0);
        const glm::dvec3 z(0.0, 0.0, step);
        const glm::dvec3 gradient(value(p + x) - value(p - x), value(p + y) - value(p - y),
                                  value(p + z) - value(p - z));
        const double length = glm::length(gradient);
        if (length == 0.0) return glm::dvec3(0.0);
        return gradient * ((value(p) < 0.0 ? -1.0 : 1.0) / length);
    }
    /// Conservative, because the slope of the value along an axis is at most 2 waves.
    static bool misses_ball_of(const glm::dvec3& middle, double reach) {
        return from_ball(middle) > reach ||
               std::abs(value(middle)) - 2.0 * std::sqrt(3.0) * waves * reach > wall;
    }
};

class GyroidContent final : public renderer::Content, public renderer::Oracle, public renderer::Producer {
public:
    explicit GyroidContent(const renderer::TreeOptions& tree) : shape_(renderer::tree_shape_of(tree)) {
        grid_.voxel_size = 1.0 / shape_.resolution();
        grid_.resolution = glm::ivec3(shape_.resolution());
    }

    // The content, which the tree shows.
    [[nodiscard]] const renderer::TreeShape& shape() const override { return shape_; }
    [[nodiscard]] renderer::Oracle& oracle() override { return *this; }
    [[nodiscard]] renderer::Producer& producer() override { return *this; }
    [[nodiscard]] const cairn::voxelizer::Grid& grid() const override { return grid_; }
    [[nodiscard]] bool has_color() const override { return true; }
    [[nodiscard]] glm::vec3 uniform_color() const override { return glm::vec3(1.0F); }
    [[nodiscard]] bool has_constant() const override { return true; }

    // The oracle. A voxel is occupied if its middle is, at every level, so a tile that the wall misses is
    // empty.
    [[nodiscard]] bool is_empty(const renderer::Tile& tile) override {
        const double side = 1.0 / shape_.tiles_across(tile.level);
        return Gyroid::misses_ball_of((glm::dvec3(tile.position) + 0.5) * side, 0.5 * std::sqrt(3.0) * side);
    }
    [[nodiscard]] glm::uvec2 child_mask(const renderer::Tile& tile) override {
        glm::uvec2 mask(0);
        if (tile.level == shape_.max_level) return mask;
        for (int child = 0; child < shape_.child_count(); ++child) {
            if (is_empty(renderer::child_of(tile, shape_.n, child))) continue;
            const int bit = renderer::mask_bit(shape_.n, child);
            mask[bit / 32] |= 1U << (bit % 32);
        }
        return mask;
    }

    // The producer.
    std::vector<renderer::ProducedTile> produce(std::span<const renderer::BrickRequest> requests,
                                                renderer::BrickPool& pool) override {
        std::vector<renderer::ProducedTile> all;
        for (const auto& [tile, slot] : requests) {
            const renderer::CpuBrick brick = make_brick(tile);
            brick.send_to(pool, slot);
            all.push_back({.constant = brick.is_empty()});
        }
        return all;
    }

private:
    [[nodiscard]] renderer::CpuBrick make_brick(const renderer::Tile& tile) const {
        renderer::CpuBrick brick(shape_, channels());
        const double voxel = 1.0 / (double(shape_.m) * shape_.tiles_across(tile.level));
        const glm::dvec3 low = glm::dvec3(tile.position) * double(shape_.m);
        for (int z = -1; z <= shape_.m; ++z) {
            for (int y = -1; y <= shape_.m; ++y) {
                for (int x = -1; x <= shape_.m; ++x) {
                    const glm::dvec3 p = (low + glm::dvec3(x, y, z) + 0.5) * voxel;
                    if (!Gyroid::holds(p)) continue;
                    const glm::vec3 color =
                        Gyroid::value(p) < 0.0 ? glm::vec3(0.9F, 0.5F, 0.2F) : glm::vec3(0.2F, 0.5F, 0.8F);
                    brick.set({x, y, z}, 1.0, glm::vec3(Gyroid::normal(p, voxel)), color);
                }
            }
        }
        return brick;
    }

    renderer::TreeShape shape_;
    cairn::voxelizer::Grid grid_;
};

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s OUTPUT.ppm\n", argv[0]);
        return 2;
    }
    const auto context = cairn::gl::create_context();
    renderer::Renderer gyroid(std::make_unique<GyroidContent>(renderer::TreeOptions{.max_resolution = 256}));
    renderer::View view;
    view.size = {256, 256};
    view.camera = cairn::optics::framing_camera({glm::dvec3(0.0), glm::dvec3(1.0)}, view.size.aspect());
    const renderer::Frame frame = gyroid.render(view);
    std::printf("%llu bricks\n", static_cast<unsigned long long>(frame.statistics.bricks_produced));
    return write_ppm(argv[1], frame.image) ? 0 : 1;
} catch (const cairn::Error& error) {
    std::fprintf(stderr, "%s\n  %s\n", error.what(), error.way_out().c_str());
    return 1;
}

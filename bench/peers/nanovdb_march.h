#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"

namespace cairn::bench {

/// A picture's rays in voxels of a grid, relative to the grid's low corner.
struct GridView {
    glm::dvec3 eye{0.0};
    glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit vector
    glm::dvec3 right{1.0, 0.0, 0.0};     ///< half the picture's width at distance 1
    glm::dvec3 up{0.0, 1.0, 0.0};        ///< half the picture's height at distance 1
    glm::dvec3 towards_light{0.0, 1.0, 0.0};
    int width = 512;
    int height = 512;
};

/// NanoVDB's hierarchical DDA on the CPU, on all cores: the first active voxel of each pixel's ray, and one
/// shadow ray from there.
class NanoVdbMarch {
public:
    explicit NanoVdbMarch(const voxelizer::BitGrid& voxels);
    ~NanoVdbMarch();
    NanoVdbMarch(const NanoVdbMarch&) = delete;
    NanoVdbMarch& operator=(const NanoVdbMarch&) = delete;
    NanoVdbMarch(NanoVdbMarch&&) = delete;
    NanoVdbMarch& operator=(NanoVdbMarch&&) = delete;

    struct Result {
        double milliseconds = 0.0;
        std::vector<std::uint8_t> hit;  ///< per pixel: 0 nothing, 1 in shadow, 2 lit
    };
    [[nodiscard]] Result march(const GridView& view) const;

private:
    struct Grid;
    std::unique_ptr<Grid> grid_;
};

}  // namespace cairn::bench

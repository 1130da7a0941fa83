#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <glm/glm.hpp>

namespace cairn::voxelizer {

/// Finds a palette of at most 255 colours. Up to 255 different colours are kept as they are. More are
/// gathered in 64^3 cells of the sRGB cube; the cells are cut by their median (Heckbert 1982), and the
/// palette's colours then moved to the means of the cells nearest to them (Lloyd 1982). The palette does not
/// depend on the order in which colours are added. Memory: 8 MiB.
class ColorPalette {
public:
    static constexpr std::size_t capacity = 255;

    void add(const glm::u8vec3& color);
    /// Computes the palette; to be called once, after the last add().
    void build();

    [[nodiscard]] const std::vector<glm::u8vec3>& colors() const { return colors_; }
    [[nodiscard]] std::uint8_t index_of(const glm::u8vec3& color) const;

private:
    struct Cell {
        std::uint64_t count = 0;
        std::array<std::uint64_t, 3> sums{};
        [[nodiscard]] glm::dvec3 mean() const {
            return glm::dvec3(sums[0], sums[1], sums[2]) / double(count);
        }
    };
    using Cells = std::vector<std::uint32_t>;  ///< numbers of cells that are not empty

    [[nodiscard]] static std::uint32_t cell_of(const glm::u8vec3& color);
    [[nodiscard]] std::vector<Cells> cut_by_median(const Cells& all) const;
    [[nodiscard]] glm::dvec3 mean_of(const Cells& cells) const;
    void move_to_means(const Cells& all);

    /// Index per colour 0xRRGGBB. Holds at most one colour more than the capacity.
    std::map<std::uint32_t, std::uint8_t> exact_;
    std::vector<Cell> cells_ = std::vector<Cell>(64 * 64 * 64);
    std::vector<glm::u8vec3> colors_;
    std::vector<std::uint8_t> index_of_cell_;
};

}  // namespace cairn::voxelizer

#include "voxelizer/files/write_binvox.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include <fmt/format.h>

#include "base/output_file.h"
#include "voxelizer/files/voxel_rows.h"

namespace cairn::voxelizer {
namespace {

class BinvoxWriter final : public VoxelWriter {
public:
    BinvoxWriter(const std::filesystem::path& path, const Grid& grid)
        : file_(path),
          rows_(grid.resolution, 1),
          size_(grid.resolution),
          side_(std::max({size_.x, size_.y, size_.z})) {
        const std::string header =
            fmt::format("#binvox 1\ndim {0} {0} {0}\ntranslate {1} {2} {3}\nscale {4}\ndata\n", side_,
                        grid.origin.x, grid.origin.y, grid.origin.z, grid.voxel_size * double(side_));
        file_.write(header.data(), header.size());
    }

    void add(const VoxelTile& tile) override { rows_.add(tile, *this); }
    void finish() override {
        rows_.finish(*this);
        const auto side = std::uint64_t(side_);
        run(false, (side - std::uint64_t(size_.x)) * side * side);
        flush();
        file_.commit();
    }

    void empty_rows(std::uint64_t count) {
        while (count != 0) {
            const std::uint64_t here = std::min<std::uint64_t>(count, std::uint64_t(size_.z - row_));
            run(false, here * std::uint64_t(side_));
            end_rows(int(here));
            count -= here;
        }
    }
    void row(std::span<const std::uint32_t> words) {
        for (std::size_t i = 0; i < words.size(); ++i) {
            const int bits = std::min(32, size_.y - int(32 * i));
            for (int bit = 0; bit < bits;) {
                const std::uint32_t left = words[i] >> bit;
                const bool value = (left & 1U) != 0;
                const int same = std::min(value ? std::countr_one(left) : std::countr_zero(left), bits - bit);
                run(value, std::uint64_t(same));
                bit += same;
            }
        }
        run(false, std::uint64_t(side_ - size_.y));
        end_rows(1);
    }

private:
    /// Past the rows of a plane, and past the planes, the cube goes on empty.
    void end_rows(int count) {
        row_ += count;
        if (row_ < size_.z) return;
        row_ = 0;
        run(false, std::uint64_t(side_ - size_.z) * std::uint64_t(side_));
    }

    void run(bool value, std::uint64_t count) {
        if (value != value_) {
            flush();
            value_ = value;
        }
        count_ += count;
    }
    void flush() {
        constexpr std::uint64_t longest = 255;
        std::array<char, 2> pair = {char(value_), char(longest)};
        for (; count_ >= longest; count_ -= longest)
            file_.write(pair.data(), pair.size());
        pair[1] = char(count_);
        if (count_ != 0) file_.write(pair.data(), pair.size());
        count_ = 0;
    }

    OutputFile file_;
    VoxelRows rows_;
    glm::ivec3 size_;
    int side_;
    int row_ = 0;  ///< number of the row in its plane
    bool value_ = false;
    std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<VoxelWriter> make_binvox_writer(const std::filesystem::path& path, const Grid& grid) {
    return std::make_unique<BinvoxWriter>(path, grid);
}

}  // namespace cairn::voxelizer

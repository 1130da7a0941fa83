#include "renderer/produce/volume_content.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/clock.h"
#include "base/error.h"
#include "renderer/pool/brick_pool.h"

namespace cairn::renderer {
namespace {

/// Side of a voxel of a coarseness, in finest voxels: n to that power.
std::int64_t voxel_side(int n, int coarseness) {
    std::int64_t side = 1;
    for (int i = 0; i < coarseness; ++i)
        side *= n;
    return side;
}

/// A density as a brick stores it. Monotonic, so bounds of a density become bounds of what is stored.
std::uint8_t stored(float density) {
    return std::uint8_t(std::lround(std::clamp(density, 0.0F, 1.0F) * 255.0F));
}

/// A brick's densities, border included, and the bounds of each voxel and the neighbours that a fetch in it
/// mixes.
class BrickVoxels {
public:
    BrickVoxels(int m, std::uint8_t* texels) : side_(m + 2), texels_(texels) {}

    [[nodiscard]] std::size_t count() const {
        return std::size_t(side_) * std::size_t(side_) * std::size_t(side_);
    }

    void fill(const Field& field, int coarseness, const glm::i64vec3& low) {
        std::vector<float> values(count());
        field.fill(coarseness, low, glm::ivec3(side_), values.data());
        std::transform(values.begin(), values.end(), texels_, stored);
    }

    /// Densities that are alike and not visible count as empty. A tile of density 0 that is visible would be
    /// taken for an empty one, and so keeps its brick.
    [[nodiscard]] ProducedTile analyse(const DensityTest& test) const {
        const auto [low, high] = std::minmax_element(texels_, texels_ + count());
        std::uint64_t sum = 0;
        const int m = side_ - 2;
        for (int z = 1; z <= m; ++z)
            for (int y = 1; y <= m; ++y)
                for (int x = 1; x <= m; ++x)
                    sum += texels_[at(x, y, z)];
        const auto voxels = std::uint64_t(m) * std::uint64_t(m) * std::uint64_t(m);
        const auto mean = std::uint8_t((sum + voxels / 2) / voxels);
        const bool shows = test.shows(*low, *high);
        const bool alike = *low == *high && !(shows && *low == 0);
        return {.constant = alike, .mean = glm::u8vec4(shows ? mean : 0, 0, 0, 0)};
    }

    /// Writes the summary words, then one word per block (shaders/pool/brick_masks.glsl).
    void write_masks(const DensityTest& test, std::uint64_t* words) const {
        std::vector<std::uint8_t> low(texels_, texels_ + count());
        std::vector<std::uint8_t> high = low;
        for (const std::size_t step :
             {std::size_t(1), std::size_t(side_), std::size_t(side_) * std::size_t(side_)}) {
            low = spread(low, step, [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
            high = spread(high, step, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
        }
        const int m = side_ - 2;
        const int side = m % 3 == 0 ? 3 : 4;  // side of a block: with n = 3, bricks are cut in thirds
        const int blocks = m / side;
        const int block_count = blocks * blocks * blocks;
        const int summaries = (block_count + 63) / 64;
        std::fill_n(words, summaries + block_count, 0);
        for (int z = 0; z < m; ++z) {
            for (int y = 0; y < m; ++y) {
                for (int x = 0; x < m; ++x) {
                    const std::size_t voxel = at(x + 1, y + 1, z + 1);
                    if (!test.shows(low[voxel], high[voxel])) continue;
                    const int block = x / side + blocks * (y / side + blocks * (z / side));
                    const int bit = x % side + side * (y % side + side * (z % side));
                    words[summaries + block] |= std::uint64_t(1) << unsigned(bit);
                    words[block / 64] |= std::uint64_t(1) << unsigned(block % 64);
                }
            }
        }
    }

private:
    [[nodiscard]] std::size_t at(int x, int y, int z) const {
        return std::size_t(x) + std::size_t(side_) * (std::size_t(y) + std::size_t(side_) * std::size_t(z));
    }
    /// The chosen value of each voxel and its neighbours one step before and behind. Voxels of the border mix
    /// in voxels that are not their neighbours, but no inner voxel reads them along the same axis again.
    template <typename Choose>
    [[nodiscard]] static std::vector<std::uint8_t> spread(const std::vector<std::uint8_t>& from,
                                                          std::size_t step, Choose choose) {
        std::vector<std::uint8_t> to = from;
        for (std::size_t i = step; i + step < from.size(); ++i)
            to[i] = choose(from[i], choose(from[i - step], from[i + step]));
        return to;
    }

    int side_;
    std::uint8_t* texels_;
};

voxelizer::Grid grid_of(const VolumeShape& shape, const FieldFrame& frame) {
    const auto finest = double(shape.finest_voxel_side());
    return {frame.origin, frame.voxel_size * finest, glm::ivec3(shape.tree.resolution())};
}

}  // namespace

DensityTest::DensityTest(const VisibleDensities& visible) {
    for (std::size_t i = 0; i < visible.size(); ++i)
        before_[i + 1] = std::uint16_t(before_[i] + (visible[i] ? 1 : 0));
}

std::int64_t VolumeShape::finest_voxel_side() const {
    return voxel_side(tree.n, finest_coarseness);
}

VolumeShape make_volume_shape(const FieldFrame& frame, int n, int m, int max_resolution) {
    if (frame.n != n) {
        throw Error(Fault::usage, "volume",
                    fmt::format("its levels are {} apart, those of the tree {}", frame.n, n),
                    "make the field for the tree's N");
    }
    const std::int64_t longest = std::max({frame.size.x, frame.size.y, frame.size.z});
    const std::int64_t most = std::min(max_resolution, most_voxels_across(n, m));
    VolumeShape shape{make_tree_shape_within(n, m, max_resolution), 0};
    while ((longest - 1) / shape.finest_voxel_side() + 1 > most)
        ++shape.finest_coarseness;
    const std::int64_t voxels = (longest - 1) / shape.finest_voxel_side() + 1;
    shape.tree = make_tree_shape(n, m, int(std::max<std::int64_t>(voxels, m)));
    return shape;
}

VolumeOracle::VolumeOracle(const VolumeShape& shape, const Field& field, const DensityTest& test)
    : shape_(shape), field_(field), test_(test) {}

glm::uvec2 VolumeOracle::child_mask(const Tile& tile) {
    glm::uvec2 mask(0);
    const TreeShape& tree = shape_.tree;
    if (tile.level >= tree.max_level) return mask;
    for (int child = 0; child < tree.child_count(); ++child) {
        const int bit = mask_bit(tree.n, child);
        if (!is_empty(child_of(tile, tree.n, child))) mask[bit / 32] |= 1U << (bit % 32);
    }
    return mask;
}

bool VolumeOracle::is_empty(const Tile& tile) {
    const std::int64_t voxel = voxel_side(shape_.tree.n, shape_.coarseness(tile.level));
    const std::int64_t side = voxel * shape_.tree.m;
    // The tile with one voxel around it: fetches near the tile's sides mix that in. Finer levels mix in less.
    const glm::i64vec3 low = tile.position * side;
    const FieldRange range = field_.range(low - voxel, low + side + voxel);
    return !test_.shows(stored(range.low), stored(range.high));
}

VolumeProducer::VolumeProducer(const VolumeShape& shape, const Field& field, const DensityTest& test,
                               std::size_t batch_bytes)
    : shape_(shape), field_(field), test_(test) {
    const BrickVoxels brick(shape.tree.m, nullptr);
    batch_ = std::max<std::size_t>(batch_bytes / brick.count(), 1);
    upload_ = gl::Buffer(batch_ * brick.count(), "brick upload");
}

std::vector<ProducedTile> VolumeProducer::produce(std::span<const BrickRequest> requests, BrickPool& pool) {
    std::vector<ProducedTile> produced(requests.size());
    upload_ms_ = 0.0;
    for (std::size_t i = 0; i < requests.size(); i += batch_) {
        const std::size_t count = std::min(batch_, requests.size() - i);
        std::vector<ProducedTile> part(count);
        produce_batch(requests.subspan(i, count), pool, part);
        std::copy(part.begin(), part.end(), produced.begin() + std::ptrdiff_t(i));
    }
    return produced;
}

void VolumeProducer::produce_batch(std::span<const BrickRequest> requests, const BrickPool& pool,
                                   std::vector<ProducedTile>& produced) {
    const TreeShape& tree = shape_.tree;
    const std::size_t texels = BrickVoxels(tree.m, nullptr).count();
    const std::size_t words = pool.mask_words();
    texels_.resize(requests.size() * texels);
    masks_.resize(requests.size() * words);
    tbb::parallel_for(std::size_t(0), requests.size(), [&](std::size_t i) {
        const Tile& tile = requests[i].tile;
        BrickVoxels brick(tree.m, texels_.data() + i * texels);
        brick.fill(field_, shape_.coarseness(tile.level),
                   tile.position * std::int64_t(tree.m) - std::int64_t(1));
        brick.write_masks(test_, masks_.data() + i * words);
        produced[i] = brick.analyse(test_);
    });
    const auto start = Clock::now();
    upload_.write(0, texels_.data(), texels_.size());
    for (std::size_t i = 0; i < requests.size(); ++i)
        pool.upload(requests[i].slot, upload_, i * texels, {masks_.data() + i * words, words});
    upload_ms_ += milliseconds_since(start);
}

VolumeContent::VolumeContent(const VolumeShape& shape, std::shared_ptr<const Field> field,
                             const TransferFunction& transfer, const VolumeOptions& options)
    : shape_(shape),
      field_(std::move(field)),
      test_(transfer.visible()),
      grid_(grid_of(shape, field_->frame())),
      steps_per_voxel_(options.steps_per_voxel),
      table_(std::make_shared<TransferTable>(transfer, options, grid_.voxel_size)),
      oracle_(shape, *field_, test_),
      producer_(shape, *field_, test_) {}

ContentProgram VolumeContent::program() const {
    return {.primary = "march/volume.comp.glsl",
            .shadow = "march/volume_shadow.comp.glsl",
            .volume_steps = steps_per_voxel_,
            .bind = [table = table_] { table->bind(); }};
}

}  // namespace cairn::renderer

#include "voxelizer/files/write_vdb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cstring>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "base/output_file.h"
#include "base/side_file.h"
#include "voxelizer/files/voxel_tiles.h"

namespace cairn::voxelizer {
namespace {

// The tree of all common grids, "5_4_3": a leaf has 8 voxels along each side, a node 16 leaves, and an upper
// node 32 nodes. A node is a tile. Children are numbered with z fastest, then y, then x; so are voxels.
constexpr int leaf_side = 8;
constexpr int node_leaves = 16;
constexpr int upper_nodes = 32;
constexpr int upper_side = upper_nodes * VOXEL_TILE_SIDE;
static_assert(node_leaves * leaf_side == VOXEL_TILE_SIDE, "a node of the tree is not a tile");

constexpr std::size_t leaf_voxels = std::size_t(leaf_side) * leaf_side * leaf_side;
using LeafMask = std::array<std::uint64_t, leaf_voxels / 64>;  // bit 8 y + z of word x
using NodeMask = std::array<std::uint64_t, std::size_t(node_leaves) * node_leaves * node_leaves / 64>;
using UpperMask = std::array<std::uint64_t, std::size_t(upper_nodes) * upper_nodes * upper_nodes / 64>;
using Half3 = std::array<std::uint16_t, 3>;

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

/// Bytes on their way to the file.
class Bytes {
public:
    template <typename T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::size_t end = bytes_.size();
        bytes_.resize(end + sizeof(T));
        std::memcpy(&bytes_[end], &value, sizeof(T));
    }
    void put_text(std::string_view text) {
        put(std::uint32_t(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }
    template <typename T>
    void put_meta(std::string_view name, std::string_view type, const T& value) {
        put_text(name);
        put_text(type);
        put(std::uint32_t(sizeof(T)));
        put(value);
    }
    void put_meta(std::string_view name, std::string_view value) {
        put_text(name);
        put_text("string");
        put_text(value);
    }
    [[nodiscard]] std::uint64_t size() const { return bytes_.size(); }
    void flush(OutputFile& file) {
        file.write(bytes_.data(), bytes_.size());
        bytes_.clear();
    }

private:
    std::vector<char> bytes_;
};

/// A tile in the side file: the node's mask, a mask a leaf, then colours, then normals, voxels in the tree's
/// order.
struct Node {
    glm::ivec3 origin{0};
    std::uint32_t leaf_count = 0;
    std::uint32_t voxel_count = 0;
    std::uint64_t place = 0;
};

glm::ivec3 upper_of(const Node& node) {
    return node.origin / upper_side;
}

/// Nodes of one upper node lie side by side, by x, then y, then z: the order of the file.
auto file_order(const Node& node) {
    const glm::ivec3 upper = upper_of(node);
    return std::tuple(upper.x, upper.y, upper.z, node.origin.x, node.origin.y, node.origin.z);
}

/// The voxels of a tile as leaves, by their place in the node.
struct LeafLayout {
    explicit LeafLayout(const BitGrid& bits);
    /// Rank of an occupied voxel among the occupied voxels, in the tree's order.
    [[nodiscard]] std::size_t place_of(const glm::ivec3& v) const;

    std::vector<LeafMask> leaves;
    std::vector<std::uint32_t> starts;  ///< places before each leaf
    std::uint32_t voxel_count = 0;

private:
    static std::size_t leaf_of(const glm::ivec3& v) {
        const glm::ivec3 leaf = v / leaf_side;
        return (std::size_t(leaf.x) * node_leaves + std::size_t(leaf.y)) * node_leaves + std::size_t(leaf.z);
    }
    static std::uint64_t bit_of(const glm::ivec3& v) {
        return std::uint64_t(1) << (v.y % leaf_side * leaf_side + v.z % leaf_side);
    }
};

LeafLayout::LeafLayout(const BitGrid& bits) : leaves(std::size_t(node_leaves) * node_leaves * node_leaves) {
    for_each_voxel(bits, [&](const glm::ivec3& v, std::size_t) {
        leaves[leaf_of(v)][std::size_t(v.x % leaf_side)] |= bit_of(v);
    });
    starts.reserve(leaves.size());
    for (const LeafMask& leaf : leaves) {
        starts.push_back(voxel_count);
        for (const std::uint64_t word : leaf)
            voxel_count += std::uint32_t(std::popcount(word));
    }
}

std::size_t LeafLayout::place_of(const glm::ivec3& v) const {
    const LeafMask& leaf = leaves[leaf_of(v)];
    const auto x = std::size_t(v.x % leaf_side);
    std::size_t place = starts[leaf_of(v)];
    for (std::size_t i = 0; i < x; ++i)
        place += std::size_t(std::popcount(leaf[i]));
    return place + std::size_t(std::popcount(leaf[x] & (bit_of(v) - 1)));
}

struct GridKind {
    std::string_view name;
    int width;    ///< values per voxel
    bool second;  ///< takes normals, not colours
    std::string_view type;
    std::string_view grid_class;
    std::string_view vector_type;
};
constexpr std::array<GridKind, 3> kinds = {
    {{"density", 1, false, "Tree_float_5_4_3_HalfFloat", "fog volume", ""},
     {"Cd", 3, false, "Tree_vec3s_5_4_3_HalfFloat", "unknown", "invariant"},
     {"N", 3, true, "Tree_vec3s_5_4_3_HalfFloat", "unknown", "covariant normalize"}}};

constexpr char no_inactive_values = 0;  // io/Compression.h: what is inactive has the background's value

class VdbWriter final : public VoxelWriter {
public:
    VdbWriter(const std::filesystem::path& path, const Grid& grid) : file_(path), side_(path), grid_(grid) {}

    [[nodiscard]] bool wants_attributes() const override { return true; }
    void add(const VoxelTile& tile) override;
    void finish() override;

private:
    struct Run {  ///< the nodes of one upper node
        std::size_t first, last;
    };

    void check_attributes(const VoxelTile& tile, std::size_t voxels);
    [[nodiscard]] std::vector<Run> runs() const;
    void write_grid(const GridKind& kind);
    void put_metadata(const GridKind& kind, Bytes& out) const;
    void put_transform(Bytes& out) const;
    void write_topology(const GridKind& kind, Bytes& out);
    void write_buffers(const GridKind& kind, Bytes& out);
    [[nodiscard]] std::uint64_t topology_bytes(const GridKind& kind) const;
    [[nodiscard]] std::uint64_t buffer_bytes(const GridKind& kind) const;
    void flush(Bytes& out) {
        written_ += out.size();
        out.flush(file_);
    }

    OutputFile file_;
    SideFile side_;
    Grid grid_;
    std::vector<Node> nodes_;
    std::uint64_t leaf_count_ = 0;
    std::uint64_t voxel_count_ = 0;
    bool has_attributes_ = false;
    glm::ivec3 low_{INT_MAX}, high_{INT_MIN};  ///< bounds of the occupied voxels
    std::uint64_t written_ = 0;
};

void VdbWriter::add(const VoxelTile& tile) {
    const LeafLayout layout(tile.bits);
    if (layout.voxel_count == 0) return;
    check_attributes(tile, layout.voxel_count);
    for_each_voxel(tile.bits, [&](const glm::ivec3& v, std::size_t) {
        low_ = glm::min(low_, tile.origin + v);
        high_ = glm::max(high_, tile.origin + v);
    });
    NodeMask mask{};
    std::vector<LeafMask> kept;
    for (std::size_t leaf = 0; leaf < layout.leaves.size(); ++leaf) {
        if (layout.leaves[leaf] == LeafMask{}) continue;
        mask[leaf / 64] |= std::uint64_t(1) << leaf % 64;
        kept.push_back(layout.leaves[leaf]);
    }
    const std::uint64_t place = side_.write(mask.data(), sizeof(mask));
    side_.write(kept.data(), kept.size() * sizeof(LeafMask));
    nodes_.push_back({tile.origin, std::uint32_t(kept.size()), layout.voxel_count, place});
    leaf_count_ += kept.size();
    voxel_count_ += layout.voxel_count;
    if (!has_attributes_) return;
    for (const std::vector<glm::vec3>* const values : {&tile.attributes.colors, &tile.attributes.normals}) {
        std::vector<Half3> halves(layout.voxel_count);
        for_each_voxel(tile.bits, [&](const glm::ivec3& v, std::size_t number) {
            Half3& half = halves[layout.place_of(v)];
            for (int axis = 0; axis < 3; ++axis)
                half[std::size_t(axis)] = glm::packHalf1x16((*values)[number][axis]);
        });
        side_.write(halves.data(), halves.size() * sizeof(Half3));
    }
}

void VdbWriter::check_attributes(const VoxelTile& tile, std::size_t voxels) {
    const std::size_t colors = tile.attributes.colors.size();
    if (nodes_.empty()) has_attributes_ = colors != 0;
    const std::size_t expected = has_attributes_ ? voxels : 0;
    if (colors != expected || tile.attributes.normals.size() != expected)
        throw Error(Fault::internal, "vdb writer",
                    "a tile has not one colour and normal a voxel, as others have");
}

std::vector<VdbWriter::Run> VdbWriter::runs() const {
    std::vector<Run> out;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (i == 0 || upper_of(nodes_[i]) != upper_of(nodes_[i - 1])) out.push_back({i, i});
        out.back().last = i + 1;
    }
    return out;
}

void VdbWriter::finish() {
    std::ranges::sort(nodes_, {}, file_order);
    Bytes out;
    out.put(std::int64_t(0x56444220));  // " BDV"
    out.put(std::uint32_t(224));        // of the file's layout
    out.put(std::uint32_t(10));         // of the library: informative
    out.put(std::uint32_t(0));
    out.put(char(1));  // grids hold their offsets in the file
    // A unique identifier, by which readers distinguish versions of a file. It is fixed, so that the same
    // voxels give the same file.
    for (const char c : std::string_view("63616972-6e00-4000-8000-000000000000"))
        out.put(c);
    out.put(std::uint32_t(1));
    out.put_meta("creator", "cairn");
    out.put(std::int32_t(has_attributes_ ? kinds.size() : 1));
    flush(out);
    for (const GridKind& kind : kinds)
        if (kind.width == 1 || has_attributes_) write_grid(kind);
    file_.commit();
}

void VdbWriter::write_grid(const GridKind& kind) {
    Bytes out;
    out.put_text(kind.name);
    out.put_text(kind.type);
    out.put_text("");  // shares no other grid's tree
    Bytes head;
    head.put(std::uint32_t(2));  // COMPRESS_ACTIVE_MASK: only active values are stored
    put_metadata(kind, head);
    put_transform(head);
    const std::uint64_t start = written_ + out.size() + 3 * sizeof(std::int64_t);
    const std::uint64_t buffers = start + head.size() + topology_bytes(kind);
    out.put(std::int64_t(start));
    out.put(std::int64_t(buffers));
    out.put(std::int64_t(buffers + buffer_bytes(kind)));
    flush(out);
    flush(head);
    write_topology(kind, out);
    write_buffers(kind, out);
}

void VdbWriter::put_metadata(const GridKind& kind, Bytes& out) const {
    out.put(std::uint32_t(kind.width == 1 ? 6 : 7));
    out.put_meta("class", kind.grid_class);
    const bool empty = voxel_count_ == 0;
    out.put_meta("file_bbox_max", "vec3i", empty ? glm::ivec3(0) : high_);
    out.put_meta("file_bbox_min", "vec3i", empty ? glm::ivec3(0) : low_);
    out.put_meta("file_voxel_count", "int64", std::int64_t(voxel_count_));
    out.put_meta("is_saved_as_half_float", "bool", char(1));
    out.put_meta("name", kind.name);
    if (kind.width != 1) out.put_meta("vector_type", kind.vector_type);
}

void VdbWriter::put_transform(Bytes& out) const {
    const double size = grid_.voxel_size;
    out.put_text("UniformScaleTranslateMap");
    out.put(grid_.origin + 0.5 * size);
    for (const double value : {size, size, 1.0 / size, 1.0 / (size * size), 0.5 / size})
        out.put(glm::dvec3(value));
}

std::uint64_t VdbWriter::topology_bytes(const GridKind& kind) const {
    const std::uint64_t root = sizeof(std::int32_t) + std::uint64_t(kind.width) * sizeof(float) + 8;
    const std::uint64_t upper = 3 * sizeof(std::int32_t) + 2 * sizeof(UpperMask) + 1;
    return root + runs().size() * upper + nodes_.size() * (2 * sizeof(NodeMask) + 1) +
           leaf_count_ * sizeof(LeafMask);
}

std::uint64_t VdbWriter::buffer_bytes(const GridKind& kind) const {
    return leaf_count_ * (sizeof(LeafMask) + 1) + voxel_count_ * std::uint64_t(kind.width) * 2;
}

void VdbWriter::write_topology(const GridKind& kind, Bytes& out) {
    out.put(std::int32_t(1));  // buffers a leaf
    for (int i = 0; i < kind.width; ++i)
        out.put(0.0F);  // background
    const std::vector<Run> all = runs();
    out.put(std::uint32_t(0));  // constant regions
    out.put(std::uint32_t(all.size()));
    std::vector<LeafMask> leaves;
    for (const Run& run : all) {
        out.put(upper_of(nodes_[run.first]) * upper_side);
        UpperMask mask{};
        for (std::size_t i = run.first; i < run.last; ++i) {
            const glm::ivec3 place = nodes_[i].origin % upper_side / VOXEL_TILE_SIDE;
            const std::size_t bit =
                (std::size_t(place.x) * upper_nodes + std::size_t(place.y)) * upper_nodes +
                std::size_t(place.z);
            mask[bit / 64] |= std::uint64_t(1) << bit % 64;
        }
        out.put(mask);
        out.put(UpperMask{});  // no active constant
        out.put(no_inactive_values);
        for (std::size_t i = run.first; i < run.last; ++i) {
            NodeMask children;
            side_.read(nodes_[i].place, children.data(), sizeof(children));
            leaves.resize(nodes_[i].leaf_count);
            side_.read(nodes_[i].place + sizeof(NodeMask), leaves.data(), leaves.size() * sizeof(LeafMask));
            out.put(children);
            out.put(NodeMask{});
            out.put(no_inactive_values);
            for (const LeafMask& leaf : leaves)
                out.put(leaf);
            flush(out);
        }
    }
    flush(out);
}

void VdbWriter::write_buffers(const GridKind& kind, Bytes& out) {
    constexpr std::uint16_t half_one = 0x3C00;
    std::vector<LeafMask> leaves;
    std::vector<Half3> values;
    for (const Node& node : nodes_) {
        std::uint64_t place = node.place + sizeof(NodeMask);
        leaves.resize(node.leaf_count);
        side_.read(place, leaves.data(), leaves.size() * sizeof(LeafMask));
        place += leaves.size() * sizeof(LeafMask);
        if (kind.width == 3) {
            values.resize(node.voxel_count);
            if (kind.second) place += values.size() * sizeof(Half3);
            side_.read(place, values.data(), values.size() * sizeof(Half3));
        }
        std::size_t voxel = 0;
        for (const LeafMask& leaf : leaves) {
            out.put(leaf);
            out.put(no_inactive_values);
            std::size_t end = voxel;
            for (const std::uint64_t word : leaf)
                end += std::size_t(std::popcount(word));
            for (; voxel < end; ++voxel) {
                if (kind.width == 3)
                    out.put(values[voxel]);
                else
                    out.put(half_one);
            }
        }
        flush(out);
    }
}

}  // namespace

std::unique_ptr<VoxelWriter> make_vdb_writer(const std::filesystem::path& path, const Grid& grid) {
    return std::make_unique<VdbWriter>(path, grid);
}

}  // namespace cairn::voxelizer

#include "voxelizer/files/write_vox.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/side_file.h"
#include "optics/srgb.h"
#include "voxelizer/files/color_palette.h"
#include "voxelizer/files/voxel_tiles.h"

namespace cairn::voxelizer {
namespace {

constexpr int model_side = 256;
static_assert(model_side % VOXEL_TILE_SIDE == 0, "a tile may lie in two models");
/// MagicaVoxel shows places from minus this to below it, along each axis.
constexpr int editor_reach = 1000;
constexpr std::uint64_t most_bytes = (1ULL << 31) - 1;
constexpr std::uint64_t model_bytes = 12 + 12 + 12 + 4;  // of a model without voxels: chunks SIZE and XYZI

constexpr std::uint64_t node_bytes = 256;   // of its two nodes in the scene graph, and more
constexpr std::uint64_t rest_bytes = 4096;  // of all other chunks, and more

/// A voxel in the side file: place in its model, as the file has it, and colour.
struct Colored {
    std::array<std::uint8_t, 3> place;
    std::array<std::uint8_t, 3> color;
};

struct Piece {  ///< the voxels of a tile, in the side file
    std::uint64_t offset;
    std::uint32_t count;
};

struct Model {
    glm::ivec3 size{0};  ///< as the file has it
    glm::ivec3 low{0};   ///< low corner in the editor's scene
    std::vector<Piece> pieces;
    std::uint64_t voxel_count = 0;
};

class Chunk {
public:
    explicit Chunk(std::string_view id) : bytes_(id) {
        bytes_.resize(12);  // sizes of the content and of its children; the latter stays 0
    }
    Chunk& put(std::int32_t value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
        return *this;
    }
    Chunk& put(std::string_view text) {
        put(std::int32_t(text.size()));
        bytes_ += text;
        return *this;
    }
    [[nodiscard]] std::string text() const {
        std::string out = bytes_;
        const auto size = std::int32_t(bytes_.size() - 12);
        std::memcpy(&out[4], &size, sizeof(size));
        return out;
    }

private:
    std::string bytes_;
};

class VoxWriter final : public VoxelWriter {
public:
    VoxWriter(const std::filesystem::path& path, const Grid& grid)
        : path_(path),
          file_(path),
          side_(path),
          grid_(grid),
          sunk_(grid.resolution.y > editor_reach ? grid.resolution.y / 2 : 0) {}

    [[nodiscard]] bool wants_attributes() const override { return true; }
    void add(const VoxelTile& tile) override;
    void finish() override;
    [[nodiscard]] std::string warning() const override;

private:
    Model& model_of(const VoxelTile& tile);
    [[nodiscard]] std::string scene_graph() const;
    [[nodiscard]] std::string palette_chunk() const;
    void write(const std::string& text) { file_.write(text.data(), text.size()); }
    void write_model(const Model& model);

    std::filesystem::path path_;
    OutputFile file_;
    SideFile side_;
    Grid grid_;
    int sunk_;  ///< how far below the editor's ground the grid begins
    ColorPalette palette_;
    std::map<std::tuple<int, int, int>, Model> models_;
    std::uint64_t bytes_ = 0;    ///< bytes of all models
    std::uint64_t outside_ = 0;  ///< voxels that MagicaVoxel does not show
};

Model& VoxWriter::model_of(const VoxelTile& tile) {
    const glm::ivec3 block = tile.origin / model_side;
    const auto [found, added] = models_.try_emplace(std::tuple(block.x, block.y, block.z));
    Model& model = found->second;
    if (!added) return model;
    const glm::ivec3 low = block * model_side;
    const glm::ivec3 size = glm::min(grid_.resolution - low, glm::ivec3(model_side));
    model.size = {size.x, size.z, size.y};
    model.low = {low.x - grid_.resolution.x / 2, grid_.resolution.z - low.z - size.z - grid_.resolution.z / 2,
                 low.y - sunk_};
    bytes_ += model_bytes;
    return model;
}

void VoxWriter::add(const VoxelTile& tile) {
    constexpr glm::u8vec3 light_grey(200);
    const std::uint64_t count = tile.bits.count();
    if (count == 0) return;
    const std::vector<glm::vec3>& colors = tile.attributes.colors;
    if (!colors.empty() && colors.size() != count)
        throw Error(Fault::internal, "vox writer", "a tile has not one colour a voxel");
    Model& model = model_of(tile);
    const glm::ivec3 in_model = tile.origin % model_side;
    std::vector<Colored> voxels;
    voxels.reserve(count);
    for_each_voxel(tile.bits, [&](const glm::ivec3& v, std::size_t number) {
        const glm::u8vec3 color = colors.empty() ? light_grey : optics::srgb8_from_linear(colors[number]);
        palette_.add(color);
        const glm::ivec3 p = in_model + v;
        const glm::ivec3 place(p.x, model.size.y - 1 - p.z, p.y);
        const glm::ivec3 in_scene = model.low + place;
        outside_ += glm::any(glm::lessThan(in_scene, glm::ivec3(-editor_reach))) ||
                            glm::any(glm::greaterThanEqual(in_scene, glm::ivec3(editor_reach)))
                        ? 1
                        : 0;
        voxels.push_back({{std::uint8_t(place.x), std::uint8_t(place.y), std::uint8_t(place.z)},
                          {color.r, color.g, color.b}});
    });
    bytes_ += 4 * count;
    if (bytes_ + rest_bytes + models_.size() * node_bytes > most_bytes) {
        throw Error(Fault::usage, path_.string(), "the voxels pass the 2 GiB that a .vox can hold",
                    "choose a lower resolution, or another format, such as .vdb");
    }
    model.pieces.push_back(
        {side_.write(voxels.data(), voxels.size() * sizeof(Colored)), std::uint32_t(count)});
    model.voxel_count += count;
}

std::string VoxWriter::warning() const {
    if (outside_ == 0) return {};
    return fmt::format(
        "{}: {} voxels lie outside of {} to {}, where MagicaVoxel shows none; other editors do",
        path_.string(), outside_, -editor_reach, editor_reach - 1);
}

void VoxWriter::finish() {
    if (models_.empty()) {  // readers want a model
        Model& model = models_[std::tuple(0, 0, 0)];
        model.size = glm::ivec3(1);
        bytes_ += model_bytes;
    }
    palette_.build();
    const std::string rest = scene_graph() + palette_chunk();
    const std::array<std::int32_t, 2> sizes = {0, std::int32_t(bytes_ + rest.size())};
    constexpr std::int32_t version = 150;
    write("VOX ");
    file_.write(&version, sizeof(version));
    write("MAIN");
    file_.write(sizes.data(), sizeof(sizes));
    for (const auto& [block, model] : models_)
        write_model(model);
    write(rest);
    file_.commit();
}

void VoxWriter::write_model(const Model& model) {
    write(Chunk("SIZE").put(model.size.x).put(model.size.y).put(model.size.z).text());
    const std::array<std::int32_t, 3> head = {std::int32_t(4 + 4 * model.voxel_count), 0,
                                              std::int32_t(model.voxel_count)};
    write("XYZI");
    file_.write(head.data(), sizeof(head));
    std::vector<Colored> voxels;
    std::vector<std::array<std::uint8_t, 4>> indexed;
    for (const Piece& piece : model.pieces) {
        voxels.resize(piece.count);
        side_.read(piece.offset, voxels.data(), voxels.size() * sizeof(Colored));
        indexed.clear();
        for (const Colored& voxel : voxels) {
            const glm::u8vec3 color(voxel.color[0], voxel.color[1], voxel.color[2]);
            indexed.push_back(
                {voxel.place[0], voxel.place[1], voxel.place[2], std::uint8_t(palette_.index_of(color) + 1)});
        }
        file_.write(indexed.data(), indexed.size() * sizeof(indexed[0]));
    }
}

/// A root, which groups a placed shape for each model.
std::string VoxWriter::scene_graph() const {
    const glm::ivec3& r = grid_.resolution;
    const std::string name = fmt::format("cairn {} {} {}, origin {} {} {}, voxel {}", r.x, r.y, r.z,
                                         grid_.origin.x, grid_.origin.y, grid_.origin.z, grid_.voxel_size);
    constexpr std::int32_t reserved = -1, no_layer = -1, layer = 0, frames = 1;
    std::string out = Chunk("nTRN")
                          .put(0)
                          .put(1)
                          .put("_name")
                          .put(name)
                          .put(1)
                          .put(reserved)
                          .put(no_layer)
                          .put(frames)
                          .put(0)
                          .text();
    Chunk group("nGRP");
    group.put(1).put(0).put(std::int32_t(models_.size()));
    for (std::int32_t i = 0; i < std::int32_t(models_.size()); ++i)
        group.put(2 + 2 * i);
    out += group.text();
    std::int32_t number = 0;
    for (const auto& [block, model] : models_) {
        const glm::ivec3 anchor = model.low + model.size / 2;
        const std::int32_t node = 2 + 2 * number;
        out += Chunk("nTRN")
                   .put(node)
                   .put(0)
                   .put(node + 1)
                   .put(reserved)
                   .put(layer)
                   .put(frames)
                   .put(1)
                   .put("_t")
                   .put(fmt::format("{} {} {}", anchor.x, anchor.y, anchor.z))
                   .text();
        out += Chunk("nSHP").put(node + 1).put(0).put(1).put(number).put(0).text();
        ++number;
    }
    return out;
}

std::string VoxWriter::palette_chunk() const {
    Chunk chunk("RGBA");
    for (std::size_t i = 0; i < 256; ++i) {
        glm::uvec3 color(0);
        if (i < palette_.colors().size()) color = palette_.colors()[i];
        chunk.put(std::int32_t(color.r | color.g << 8 | color.b << 16 | 0xFF000000U));
    }
    return chunk.text();
}

}  // namespace

std::unique_ptr<VoxelWriter> make_vox_writer(const std::filesystem::path& path, const Grid& grid) {
    return std::make_unique<VoxWriter>(path, grid);
}

}  // namespace cairn::voxelizer

#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/tree_shape.h"
#include "voxelizer/grid.h"

/// What a content is made of: an Oracle, which reports what is empty, and a Producer, which fills bricks.
/// Implement the three classes to show content of your own; CpuBrick (renderer/produce/cpu_brick.h) helps.
namespace cairn::renderer {

class BrickPool;

/// Reports which tiles are empty, without producing anything (Crassin et al. 2008, section 6.2).
class Oracle {
public:
    Oracle() = default;
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;
    Oracle(Oracle&&) = delete;
    Oracle& operator=(Oracle&&) = delete;
    virtual ~Oracle() = default;

    /// The child mask of a tile, as NodeEntry holds it. Bit x + n (y + n z) is 0 only if child (x, y, z) of
    /// the tile is certainly empty. With n = 8, bit x + 4 (y + 4 z) is 0 only if all of the group of 2^3
    /// children from (2 x, 2 y, 2 z) on are certainly empty.
    [[nodiscard]] virtual glm::uvec2 child_mask(const Tile& tile) = 0;

    /// Is the tile certainly empty, at every level? Asked if a bit of a child mask stands for several tiles
    /// (n = 8).
    [[nodiscard]] virtual bool is_empty(const Tile& tile) {
        (void)tile;
        return false;
    }
};

/// A tile whose brick a producer shall fill, and the slot of the brick pool that the brick goes to.
struct BrickRequest {
    Tile tile;
    int slot = 0;
};

/// What a tile turned out to hold when it was produced (Crassin et al. 2008, section 6.1). It depends on the
/// tile alone.
struct ProducedTile {
    /// Words of its packed brick if the pool had no room for it; else 0.
    std::uint32_t words_without_room = 0;
    /// Every voxel at the tile's own level has the same value; so have those of the border, unless the value
    /// is 0. The tile needs no brick. Its children may hold more. A value other than 0 needs
    /// Content::has_constant().
    bool constant = false;
    /// Finer levels would add nothing to what the tile holds at its own level: the tile is not subdivided.
    /// Needs Content::has_low_frequency().
    bool low_frequency = false;
    /// Mean of the tile's voxels, encoded as the colour texels of the brick pool are; x alone if the pool has
    /// one channel. 0 is empty.
    glm::u8vec4 mean{0};
};

/// Fills bricks on demand (Crassin et al. 2008, section 6.1).
class Producer {
public:
    Producer() = default;
    Producer(const Producer&) = delete;
    Producer& operator=(const Producer&) = delete;
    Producer(Producer&&) = delete;
    Producer& operator=(Producer&&) = delete;
    virtual ~Producer() = default;

    /// Writes the whole slot of each request: colour or coverage, normal, masks, border included. The same
    /// tile gives the same texels whatever it is produced with. Packed bricks get their room from the pool
    /// (BrickPool::reserve).
    /// @return  one ProducedTile per request, in the order of the requests.
    virtual std::vector<ProducedTile> produce(std::span<const BrickRequest> requests, BrickPool& pool) = 0;

    /// Milliseconds that the last produce() took to send bricks to the GPU; 0 if the GPU makes them itself.
    [[nodiscard]] virtual double upload_ms() const { return 0.0; }
};

/// How rays see a kind of content: the shaders that march it, and what they need beside the pools.
struct ContentProgram {
    /// Shader of the rays from the eye.
    std::string primary = "march/primary.comp.glsl";
    /// Shader of the rays to the light.
    std::string shadow = "march/shadow.comp.glsl";
    /// Steps in which a ray crosses a voxel of a volume, at least 1. 0: the content is a surface, whose
    /// shadow rays support SHOW_LIGHT and cones.
    int volume_steps = 0;
    /// Tiles may hold one value that is not 0, without a brick.
    bool has_constant = false;
    /// Tiles may have nothing finer to show.
    bool has_final = false;
    /// Called before each pass; may be empty.
    std::function<void()> bind = nullptr;
    [[nodiscard]] bool is_surface() const { return volume_steps == 0; }
};

/// What a tree shows: the cube that the root covers, the oracle that reports what is empty in it, and the
/// producer that fills its bricks.
class Content {
public:
    Content() = default;
    Content(const Content&) = delete;
    Content& operator=(const Content&) = delete;
    Content(Content&&) = delete;
    Content& operator=(Content&&) = delete;
    virtual ~Content() = default;

    /// Shape of the tree that the content is made for.
    [[nodiscard]] virtual const TreeShape& shape() const = 0;
    [[nodiscard]] virtual Oracle& oracle() = 0;
    [[nodiscard]] virtual Producer& producer() = 0;
    /// The grid that the root covers. It has as many voxels as the finest level of the tree.
    [[nodiscard]] virtual const voxelizer::Grid& grid() const = 0;
    /// Do bricks hold colours? If not, everything has uniform_color().
    [[nodiscard]] virtual bool has_color() const = 0;
    [[nodiscard]] virtual Channels channels() const { return {.color = has_color()}; }
    /// Linear colour of a content without colours.
    [[nodiscard]] virtual glm::vec3 uniform_color() const = 0;
    /// How rays see the content: like a surface by default.
    [[nodiscard]] virtual ContentProgram program() const { return {}; }
    /// Does the producer fill the mip levels of bricks (TreeShape::mips)?
    [[nodiscard]] virtual bool fills_mips() const { return false; }
    /// May the producer find tiles that are constant and not empty? Then the tree keeps their values, and
    /// rays march them.
    [[nodiscard]] virtual bool has_constant() const { return false; }
    /// May the producer find tiles to which finer levels add nothing (ProducedTile::low_frequency)? Then each
    /// tile is produced before it is subdivided, so that what a ray sees does not depend on earlier views.
    [[nodiscard]] virtual bool has_low_frequency() const { return false; }
};

}  // namespace cairn::renderer

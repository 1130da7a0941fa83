#include "voxelizer/surface/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include "base/error.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface_attributes.h"
#include "voxelizer/surface/surface_materials.h"

namespace cairn::voxelizer {
namespace {

constexpr std::int64_t lattice_side = std::int64_t(1) << LATTICE_BITS;

/// One item on the lattice; triangles number its own vertices.
struct Part {
    SurfaceChunk mesh;
    std::vector<FarTriangle> far_triangles;
    std::vector<std::array<glm::i64vec3, 3>> outside_triangles;
    bool has_color = false;
    bool has_mask = false;
};

/// A coordinate on the grid of 1 / TEXCOORD_UNITS, where shaders can compute with it exactly.
float rounded_texcoord(float coordinate) {
    if (!std::isfinite(coordinate)) return 0.0F;
    const double limited = std::clamp(double(coordinate), -TEXCOORD_LIMIT, TEXCOORD_LIMIT);
    return float(std::round(limited * TEXCOORD_UNITS) / TEXCOORD_UNITS);
}

/// Octahedral map (Cigolle et al. 2014). Straight up would be 0, which means "none": it leans by the least
/// step.
std::uint32_t encode_normal(const glm::dvec3& normal) {
    const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    if (!(sum > 0.0) || !std::isfinite(sum)) return 0;
    glm::dvec2 e(normal.x / sum, normal.y / sum);
    if (normal.z < 0.0) {
        const glm::dvec2 folded = 1.0 - glm::dvec2(std::abs(e.y), std::abs(e.x));
        e = {e.x >= 0.0 ? folded.x : -folded.x, e.y >= 0.0 ? folded.y : -folded.y};
    }
    const auto snorm = [](double value) {
        return std::uint32_t(std::uint16_t(std::int16_t(std::lround(value * 32767.0))));
    };
    const std::uint32_t packed = snorm(e.x) | snorm(e.y) << 16;
    return packed != 0 ? packed : 1;
}

bool on_lattice_range(const glm::i64vec3& p) {
    return glm::all(glm::greaterThanEqual(p, glm::i64vec3(-lattice_side))) &&
           glm::all(glm::lessThanEqual(p, glm::i64vec3(2 * lattice_side)));
}

/// Puts one item on the lattice: only triangles that reach the root cube, only vertices that these use.
class Flattener {
public:
    /// @param options  attributes: also where only masks ask for them
    Flattener(const scenes::Scene& scene, const scenes::Snapshot& snapshot, std::size_t item,
              const Grid& grid, const SurfaceMaterials& materials, const SurfaceOptions& options)
        : item_(snapshot.items[item]),
          item_number_(std::uint32_t(item)),
          primitive_(*item_.primitive),
          materials_(materials),
          options_(options),
          numbers_(item_.vertex_count(), -1) {
        if (primitive_.material >= 0) {
            uv_from_mesh_ = scene.materials[std::size_t(primitive_.material)].uv_from_mesh;
        }
        // glTF: a mirrored node turns the front of its triangles with it.
        mirrored_ = primitive_.topology == scenes::Topology::triangles &&
                    glm::determinant(glm::dmat3(item_.world_from_mesh)) < 0.0;
        if (options.unplaced) return;
        has_normals_ = !item_.normals.empty();
        normal_from_mesh_ = normal_from_mesh(item_.world_from_mesh);
        // Vertices that nothing uses may lie anywhere.
        std::vector<bool> is_placed(item_.vertex_count());
        lattice_.resize(item_.vertex_count());
        for (const std::uint32_t vertex : primitive_.indices) {
            if (is_placed[vertex]) continue;
            is_placed[vertex] = true;
            lattice_[vertex] = grid.lattice_from_world(item_.world(vertex));
        }
    }

    Part run() {
        const std::size_t corners = primitive_.topology == scenes::Topology::triangles ? 3
                                    : primitive_.topology == scenes::Topology::lines   ? 2
                                                                                       : 1;
        part_.mesh.triangles.reserve(primitive_.element_count());
        for (std::size_t first = 0; first + corners <= primitive_.indices.size(); first += corners) {
            std::array<std::uint32_t, 3> vertices{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                vertices[corner] = primitive_.indices[first + std::min(corner, corners - 1)];
            }
            add(vertices);
        }
        for (const glm::u16vec4& color : primitive_.colors) {
            part_.has_color = part_.has_color || glm::u16vec3(color) != glm::u16vec3(65535);
        }
        return std::move(part_);
    }

private:
    /// @param item_vertices  numbered in this order, whatever their front
    void add(const std::array<std::uint32_t, 3>& item_vertices) {
        std::array<std::uint32_t, 3> vertices = item_vertices;
        if (mirrored_) std::swap(vertices[1], vertices[2]);
        const glm::i64vec3 a = lattice(vertices[0]);
        const glm::i64vec3 b = lattice(vertices[1]);
        const glm::i64vec3 c = lattice(vertices[2]);
        const glm::i64vec3 low = glm::min(glm::min(a, b), c);
        const glm::i64vec3 high = glm::max(glm::max(a, b), c);
        int axes_apart = 0;
        for (int axis = 0; axis < 3; ++axis)
            axes_apart += int(high[axis] < 0 || low[axis] > lattice_side);
        if (axes_apart > (options_.outside ? 1 : 0)) return;
        Shown shown = Shown::whole;
        if (materials_.is_masked(primitive_.material)) {
            shown = materials_.shown(primitive_.material,
                                     {texcoord(vertices[0]), texcoord(vertices[1]), texcoord(vertices[2])},
                                     {color(vertices[0]).a, color(vertices[1]).a, color(vertices[2]).a});
            if (shown == Shown::nothing) return;
        }
        if (axes_apart > 0) {
            if (shown == Shown::whole) part_.outside_triangles.push_back({a, b, c});
            return;
        }
        part_.has_mask = part_.has_mask || shown == Shown::cut;
        const std::uint32_t material = materials_.number(primitive_.material, shown);
        if (on_lattice_range(a) && on_lattice_range(b) && on_lattice_range(c)) {
            for (const std::uint32_t vertex : item_vertices)
                (void)number(vertex);
            part_.mesh.triangles.push_back(
                {{number(vertices[0]), number(vertices[1]), number(vertices[2])}, material});
        } else {
            part_.far_triangles.push_back(
                {{a, b, c},
                 {texcoord(vertices[0]), texcoord(vertices[1]), texcoord(vertices[2])},
                 {color(vertices[0]), color(vertices[1]), color(vertices[2])},
                 material});
        }
    }

    [[nodiscard]] glm::i64vec3 lattice(std::uint32_t vertex) const {
        return options_.unplaced ? glm::i64vec3(0) : lattice_[vertex];
    }

    [[nodiscard]] glm::vec2 texcoord(std::uint32_t vertex) const {
        if (primitive_.texcoords.empty()) return glm::vec2(0.0F);
        const glm::vec3 uv = uv_from_mesh_ * glm::vec3(primitive_.texcoords[vertex], 1.0F);
        return {rounded_texcoord(uv.x), rounded_texcoord(uv.y)};
    }

    [[nodiscard]] glm::u16vec4 color(std::uint32_t vertex) const {
        return primitive_.colors.empty() ? glm::u16vec4(65535) : primitive_.colors[vertex];
    }

    /// The number of a vertex in the part; it is added at its first use.
    std::uint32_t number(std::uint32_t vertex) {
        std::int32_t& number = numbers_[vertex];
        if (number < 0) {
            number = std::int32_t(part_.mesh.positions.size());
            const glm::ivec3 position(lattice(vertex));
            part_.mesh.positions.push_back({position.x, position.y, position.z});
            if (options_.unplaced) part_.mesh.sources.push_back({item_number_, vertex});
            if (options_.attributes) {
                const std::uint32_t normal =
                    has_normals_ ? encode_normal(normal_from_mesh_ * glm::dvec3(item_.normals[vertex])) : 0;
                part_.mesh.attributes.push_back(surface_attributes(normal, color(vertex), texcoord(vertex)));
            }
        }
        return std::uint32_t(number);
    }

    const scenes::Item& item_;
    std::uint32_t item_number_;
    const scenes::Primitive& primitive_;
    const SurfaceMaterials& materials_;
    const SurfaceOptions& options_;
    bool mirrored_ = false;
    bool has_normals_ = false;
    glm::mat3 uv_from_mesh_{1.0F};
    glm::dmat3 normal_from_mesh_{1.0};
    std::vector<glm::i64vec3> lattice_;
    std::vector<std::int32_t> numbers_;
    Part part_;
};

/// Appends triangles to the last chunk, and starts new ones as they fill up. A chunk holds only vertices that
/// its own triangles use, at most three each, so that its buffers stay small whatever the meshes share.
void append(Surface& surface, const SurfaceChunk& part) {
    std::vector<std::int32_t> numbers;
    for (std::size_t first = 0; first < part.triangles.size();) {
        if (surface.chunks.empty() || surface.chunks.back().triangles.size() == surface.chunk_triangles) {
            surface.chunks.emplace_back();
        }
        SurfaceChunk& chunk = surface.chunks.back();
        const std::size_t room = surface.chunk_triangles - chunk.triangles.size();
        const std::size_t last = std::min(part.triangles.size(), first + room);
        numbers.assign(part.positions.size(), -1);
        for (; first < last; ++first) {
            interop::SurfaceTriangle triangle = part.triangles[first];
            // Numbered as in the part, so that a vertex's number does not depend on where the front is.
            std::array<std::uint32_t, 3> in_order = {triangle.vertices.x, triangle.vertices.y,
                                                     triangle.vertices.z};
            std::ranges::sort(in_order);
            for (const std::uint32_t vertex : in_order) {
                std::int32_t& number = numbers[vertex];
                if (number < 0) {
                    number = std::int32_t(chunk.positions.size());
                    chunk.positions.push_back(part.positions[vertex]);
                    if (!part.attributes.empty()) chunk.attributes.push_back(part.attributes[vertex]);
                    if (!part.sources.empty()) chunk.sources.push_back(part.sources[vertex]);
                }
            }
            for (int corner = 0; corner < 3; ++corner) {
                std::uint32_t& vertex = triangle.vertices[corner];
                vertex = std::uint32_t(numbers[vertex]);
            }
            chunk.triangles.push_back(triangle);
        }
    }
}

void flatten(Surface& surface, const scenes::Scene& scene, const scenes::Snapshot& snapshot,
             const SurfaceMaterials& materials, const SurfaceOptions& options) {
    // Items side by side, a bounded number of triangles at a time: the parts exist beside the surface.
    constexpr std::size_t group_triangles = std::size_t(1) << 19;
    const std::vector<scenes::Item>& items = snapshot.items;
    for (std::size_t first = 0; first < items.size();) {
        std::size_t last = first;
        for (std::size_t triangles = 0; last < items.size() && triangles < group_triangles; ++last) {
            triangles += items[last].primitive->element_count();
        }
        std::vector<Part> parts(last - first);
        // With the caller's floating-point mode: without it, threads have that of whoever used TBB first, and
        // Embree, for one, flushes denormal numbers to zero.
        tbb::task_group_context context(
            tbb::task_group_context::isolated,
            tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
        tbb::parallel_for(
            std::size_t(0), parts.size(),
            [&](std::size_t i) {
                parts[i] = Flattener(scene, snapshot, first + i, surface.grid, materials, options).run();
            },
            context);
        for (const Part& part : parts) {
            append(surface, part.mesh);
            surface.far_triangles.insert(surface.far_triangles.end(), part.far_triangles.begin(),
                                         part.far_triangles.end());
            surface.outside_triangles.insert(surface.outside_triangles.end(), part.outside_triangles.begin(),
                                             part.outside_triangles.end());
            surface.triangle_count += part.mesh.triangles.size() + part.far_triangles.size();
            surface.has_color = surface.has_color || part.has_color;
            surface.has_mask = surface.has_mask || part.has_mask;
        }
        first = last;
    }
}

}  // namespace

SurfaceChunk::SurfaceChunk() = default;
SurfaceChunk::SurfaceChunk(const SurfaceChunk&) = default;
SurfaceChunk::SurfaceChunk(SurfaceChunk&&) noexcept = default;
SurfaceChunk& SurfaceChunk::operator=(const SurfaceChunk&) = default;
SurfaceChunk& SurfaceChunk::operator=(SurfaceChunk&&) noexcept = default;
SurfaceChunk::~SurfaceChunk() = default;

Surface::Surface() = default;
Surface::Surface(const Surface&) = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(const Surface&) = default;
Surface& Surface::operator=(Surface&&) noexcept = default;
Surface::~Surface() = default;

glm::dmat3 normal_from_mesh(const glm::dmat4& world_from_mesh) {
    const glm::dmat3 linear(world_from_mesh);
    return glm::determinant(linear) != 0.0 ? glm::transpose(glm::inverse(linear)) : glm::dmat3(0.0);
}

Surface build_surface(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const Grid& grid,
                      const SurfaceOptions& options) {
    try {
        SurfaceMaterials materials(scene, snapshot, options.attributes);
        Surface surface;
        surface.grid = grid;
        surface.chunk_triangles = std::clamp(options.chunk_triangles, 1U, surface_chunk_triangles);
        surface.has_color = materials.has_color;
        surface.uniform_color = materials.uniform_color;
        SurfaceOptions wanted = options;
        wanted.attributes = options.attributes || materials.any_masked;
        flatten(surface, scene, snapshot, materials, wanted);
        surface.materials = std::move(materials.materials);
        surface.texels = std::move(materials.texels);
        return surface;
    } catch (const std::bad_alloc&) {
        throw Error(Fault::memory, scene.name, "its triangles do not fit in memory",
                    "voxelize a part of it (grid_over())");
    }
}

}  // namespace cairn::voxelizer

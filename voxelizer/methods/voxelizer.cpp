#include "voxelizer/methods/voxelizer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/pyramid_builder.h"
#include "voxelizer/methods/raster_voxelizer.h"

namespace cairn::voxelizer {
namespace {

static_assert(voxel_region_side == VOXEL_REGION_SIDE, "the shaders take other regions");

constexpr std::array<std::pair<Method, std::string_view>, 4> method_names = {
    {{Method::conservative, "conservative"},
     {Method::slice_map, "slice-map"},
     {Method::three_axis, "three-axis"},
     {Method::three_axis_conservative, "three-axis-conservative"}}};

void check_region(const Region& region) {
    if (region.level < 0 || region.level > LATTICE_BITS ||
        glm::any(glm::lessThan(region.size, glm::ivec3(1)))) {
        throw Error(Fault::usage, "region",
                    fmt::format("level {} and size {} x {} x {} are out of range", region.level,
                                region.size.x, region.size.y, region.size.z));
    }
    if (glm::any(glm::greaterThan(region.size, glm::ivec3(VOXEL_REGION_SIDE)))) {
        throw Error(Fault::usage, "region",
                    fmt::format("{} x {} x {} voxels are too many along one axis", region.size.x,
                                region.size.y, region.size.z),
                    fmt::format("cut it in parts of at most {}", VOXEL_REGION_SIDE));
    }
    const std::size_t limit = gl::query_limits().shader_storage_bytes;
    const double bytes = std::ceil(region.size.x / 32.0) * 4.0 * region.size.y * region.size.z;
    if (bytes <= double(limit)) return;
    const int side = int(std::cbrt(double(limit) * 8.0)) / 32 * 32;
    throw Error(
        Fault::memory, "voxels",
        fmt::format("{} x {} x {} take {:.0f} MiB, more than a shader of this driver can see ({} MiB)",
                    region.size.x, region.size.y, region.size.z, bytes / 0x1p20, limit >> 20),
        fmt::format("{0} x {0} x {0} would fit", side));
}

}  // namespace

BatchLimits BatchLimits::usable() const {
    BatchLimits out = *this;
    for (std::uint32_t* const limit :
         {&out.triangles, &out.candidates, &out.pairs, &out.part_voxels, &out.threads})
        *limit = std::max(*limit, 1U);
    return out;
}

Method method_named(std::string_view name) {
    std::string known;
    for (const auto& [method, its_name] : method_names) {
        if (name == its_name) return method;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", its_name);
    }
    throw Error(Fault::usage, "", fmt::format("there is no method \"{}\"", name),
                fmt::format("choose one of: {}", known));
}

std::string_view name_of(Method method) {
    for (const auto& [known, name] : method_names)
        if (known == method) return name;
    return "";
}

std::span<const Method> methods() {
    static constexpr auto all = [] {
        std::array<Method, method_names.size()> out{};
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = method_names[i].first;
        return out;
    }();
    return all;
}

std::unique_ptr<Voxelizer> make_voxelizer(Method method, const gl::ShaderSource& shaders,
                                          const BatchLimits& limits) {
    switch (method) {
        case Method::conservative:
            return std::make_unique<ConservativeVoxelizer>(shaders, limits);
        case Method::slice_map:
        case Method::three_axis:
        case Method::three_axis_conservative:
            return std::make_unique<RasterVoxelizer>(method, shaders, LayerPath::geometry_shader, limits);
    }
    throw Error(Fault::internal, "make_voxelizer", "a method that is not one");
}

Voxelizer::Voxelizer(const gl::ShaderSource& shaders)
    : shaders_(shaders), pyramid_(std::make_unique<PyramidBuilder>(shaders)) {}

Voxelizer::~Voxelizer() = default;

double Voxelizer::last_pyramid_milliseconds() const {
    return pyramid_->last_milliseconds();
}

void Voxelizer::mark_timed(const GpuSurface& surface, const Region& region,
                           std::optional<std::span<const std::uint32_t>> subset) {
    check_region(region);
    const std::size_t bytes = bit_bytes(region.size);
    if (bits_.size_bytes() != bytes) bits_ = gl::Buffer(bytes, "voxel bits");
    parts_.clear();
    parts_.resize(surface.chunks.size());
    for (std::size_t chunk = 0; chunk < parts_.size(); ++chunk) {
        parts_[chunk].count = surface.chunks[chunk].triangle_count;
        if (!subset) continue;
        const std::vector<std::uint32_t> local = surface.subset_in_chunk(*subset, chunk);
        parts_[chunk] = {local.size(), gl::Buffer::of(std::span<const std::uint32_t>(local), "voxel subset")};
    }
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    mark(surface, region, parts_, bits_);
    glFinish();
    last_milliseconds_ = milliseconds_since(start);
}

BitGrid Voxelizer::voxelize(const GpuSurface& surface, const Region& region,
                            std::optional<std::span<const std::uint32_t>> subset) {
    BitGrid out;
    voxelize_into(surface, region, out, subset);
    return out;
}

void Voxelizer::voxelize_into(const GpuSurface& surface, const Region& region, BitGrid& out,
                              std::optional<std::span<const std::uint32_t>> subset) {
    mark_timed(surface, region, subset);
    out.size = region.size;
    out.words.resize(bit_bytes(region.size) / sizeof(std::uint32_t));
    bits_.read(0, out.words.data(), bit_bytes(region.size));
}

const gl::Buffer& Voxelizer::voxelize_on_gpu(const GpuSurface& surface, const Region& region,
                                             std::optional<std::span<const std::uint32_t>> subset) {
    mark_timed(surface, region, subset);
    return bits_;
}

BitmaskPyramid Voxelizer::voxelize_pyramid(const GpuSurface& surface, const Region& region,
                                           std::optional<std::span<const std::uint32_t>> subset,
                                           Reduction reduction) {
    mark_timed(surface, region, subset);
    return pyramid_->build(bits_, region.size, reduction);
}

}  // namespace cairn::voxelizer

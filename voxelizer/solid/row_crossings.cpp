#include "voxelizer/solid/row_crossings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "shaders/interop/grid.h"
#include "voxelizer/solid/solid_triangles.h"
#include "voxelizer/surface/crossed_rows.h"

namespace cairn::voxelizer {
namespace {

/// Calls visit(u, v, rows) for each row that a triangle crosses.
template <typename Int, typename Visit>
void visit_rows(const std::array<std::array<Int, 3>, 3>& corners, const Region& region, int axis,
                const Visit& visit) {
    const CrossedRows<Int> rows(corners, region, axis);
    if (rows.winding() == 0) return;
    for (int v = rows.first_v(); v <= rows.last_v(); ++v) {
        const auto interval = rows.crossed_u(v);
        for (int u = interval.first; u <= interval.last; ++u)
            visit(u, v, rows);
    }
}

bool in_shader_range(const std::array<glm::i64vec3, 3>& p) {
    constexpr std::int64_t side = std::int64_t(1) << LATTICE_BITS;
    return std::all_of(p.begin(), p.end(), [](const glm::i64vec3& corner) {
        return glm::all(glm::greaterThanEqual(corner, glm::i64vec3(-side))) &&
               glm::all(glm::lessThanEqual(corner, glm::i64vec3(2 * side)));
    });
}

template <typename Int>
std::array<std::array<Int, 3>, 3> as(const std::array<glm::i64vec3, 3>& p) {
    std::array<std::array<Int, 3>, 3> out;
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = {Int(p[i].x), Int(p[i].y), Int(p[i].z)};
    return out;
}

template <typename Visit>
void visit_all(const Surface& surface, const Region& region, int axis, const Visit& visit) {
    for_each_triangle(surface, [&](const std::array<glm::i64vec3, 3>& corners) {
        if (in_shader_range(corners)) {
            visit_rows(as<std::int64_t>(corners), region, axis, visit);
        } else {
            visit_rows(as<Int128>(corners), region, axis, visit);
        }
    });
}

void check_memory(double needed_bytes, std::size_t limit_bytes, const Region& region) {
    if (needed_bytes <= double(limit_bytes)) return;
    const double share = std::sqrt(double(limit_bytes) / needed_bytes);
    throw Error(
        Fault::memory, "solid fill",
        fmt::format("the crossings of {} x {} x {} voxels take {:.0f} MiB, more than the {} MiB allowed",
                    region.size.x, region.size.y, region.size.z, needed_bytes / 0x1p20, limit_bytes >> 20),
        fmt::format("{} x {} x {} would fit", int(region.size.x * share), int(region.size.y * share),
                    int(region.size.z * share)));
}

}  // namespace

RowCrossings::RowCrossings(const Surface& surface, const Region& region, int axis, std::size_t memory_bytes)
    : u_((axis + 1) % 3), v_((axis + 2) % 3), u_size_(region.size[u_]) {
    const std::size_t row_count = std::size_t(u_size_) * std::size_t(region.size[v_]);
    const double row_bytes = double(row_count) * (sizeof(std::uint32_t) + 0.125);
    check_memory(row_bytes, memory_bytes, region);
    ends_.assign(row_count, 0);
    odd_.assign(row_count, false);
    // Counted first; then `ends_` holds where each row starts, and grows to where it ends.
    visit_all(surface, region, axis, [&](int u, int v, const auto& /*rows*/) {
        const std::size_t row = std::size_t(v) * std::size_t(u_size_) + std::size_t(u);
        std::atomic_ref(ends_[row]).fetch_add(1, std::memory_order_relaxed);
    });
    for (std::size_t row = 0; row < row_count; ++row) {
        if (ends_[row] % 2 == 0) continue;
        odd_[row] = true;
        ends_[row] = 0;
    }
    const std::uint64_t total = std::accumulate(ends_.begin(), ends_.end(), std::uint64_t(0));
    // Rows are numbered into the events by 32 bits.
    const std::size_t limit_bytes = std::min<std::size_t>(memory_bytes, std::size_t(1) << 34);
    check_memory(row_bytes + double(total) * sizeof(Event), limit_bytes, region);
    events_.resize(total);
    std::uint32_t next = 0;
    for (std::uint32_t& end : ends_)
        next += std::exchange(end, next);
    const int length = region.size[axis];
    visit_all(surface, region, axis, [&](int u, int v, const auto& rows) {
        const std::size_t row = std::size_t(v) * std::size_t(u_size_) + std::size_t(u);
        if (odd_[row]) return;
        const std::uint32_t place = std::atomic_ref(ends_[row]).fetch_add(1, std::memory_order_relaxed);
        const auto voxel = std::uint32_t(std::clamp<std::int64_t>(rows.first_beyond(u, v), 0, length));
        events_[place].packed = voxel << 1 | std::uint32_t(rows.winding() < 0);
    });
    tbb::parallel_for(std::size_t(0), row_count, [&](std::size_t row) {
        const auto first = events_.begin() + std::ptrdiff_t(row == 0 ? 0 : ends_[row - 1]);
        std::sort(first, events_.begin() + std::ptrdiff_t(ends_[row]),
                  [](const Event& a, const Event& b) { return a.packed < b.packed; });
    });
}

}  // namespace cairn::voxelizer

#include "voxelizer/solid/cavities.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

#include <tbb/parallel_for.h>

namespace cairn::voxelizer {
namespace {

/// What lies behind the walls of a part: numbers of border voxels.
struct Walls {
    std::uint64_t positive = 0, negative = 0;  ///< of winding numbers
    std::uint64_t solid = 0;                   ///< inside, though the row has no winding numbers
    std::uint64_t nothing = 0;
    bool is_wound_around = false;  ///< the part itself

    void add(const Walls& other) {
        positive += other.positive;
        negative += other.negative;
        solid += other.solid;
        nothing += other.nothing;
        is_wound_around = is_wound_around || other.is_wound_around;
    }
    [[nodiscard]] bool give_doubt() const {
        return is_wound_around || (positive > 0 && negative > 0) || nothing > positive + negative + solid;
    }
};

/// Looks behind the walls of one run.
class Prober {
public:
    Prober(const SolidFill& crossings, const Outside& outside, const VoxelRuns& runs)
        : crossings_(crossings), outside_(outside), runs_(runs) {}

    [[nodiscard]] Walls behind(const VoxelRun& run) const {
        Walls walls;
        walls.is_wound_around = crossings_.winding_at(run.first).value_or(0) != 0;
        look(run.first, {-1, 0, 0}, walls);
        look({run.end() - 1, run.first.y, run.first.z}, {1, 0, 0}, walls);
        for (const glm::ivec3& step :
             {glm::ivec3(0, -1, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, -1), glm::ivec3(0, 0, 1)}) {
            // Voxels beside another run of the part are not at the border.
            int x = run.first.x;
            for (const VoxelRun& beside : runs_.row(run.first.y + step.y, run.first.z + step.z)) {
                for (; x < std::min(beside.first.x, run.end()); ++x)
                    look({x, run.first.y, run.first.z}, step, walls);
                x = std::max(x, beside.end());
            }
            for (; x < run.end(); ++x)
                look({x, run.first.y, run.first.z}, step, walls);
        }
        return walls;
    }

private:
    void look(const glm::ivec3& from, const glm::ivec3& step, Walls& walls) const {
        constexpr int thickest_wall = 4;
        for (int i = 1; i <= thickest_wall; ++i) {
            const glm::ivec3 voxel = from + i * step;
            if (!outside_.holds(voxel)) return;  // nobody knows
            const std::optional<int> winding = crossings_.winding_at(voxel);
            if (winding.value_or(0) != 0) {
                ++(*winding > 0 ? walls.positive : walls.negative);
                return;
            }
            if (!winding && crossings_.is_inside(voxel)) {
                ++walls.solid;
                return;
            }
            if (!outside_.touches(voxel)) break;
        }
        ++walls.nothing;
    }

    const SolidFill& crossings_;
    const Outside& outside_;
    const VoxelRuns& runs_;
};

}  // namespace

std::size_t Cavities::size_bytes() const {
    return runs_.size_bytes() / sizeof(VoxelRun) * (sizeof(VoxelRun) + sizeof(Walls) + sizeof(parents_[0]));
}

std::uint32_t Cavities::part_of(std::uint32_t run) {
    while (parents_[run] != run) {
        parents_[run] = parents_[parents_[run]];
        run = parents_[run];
    }
    return run;
}

void Cavities::join(std::uint32_t a, std::uint32_t b) {
    a = part_of(a);
    b = part_of(b);
    parents_[std::max(a, b)] = std::min(a, b);
}

void Cavities::join_with_row(std::uint32_t run, int y, int z) {
    const VoxelRun& here = runs_.all()[run];
    for (const VoxelRun& beside : runs_.row(y, z)) {
        if (beside.first.x < here.end() && here.first.x < beside.end())
            join(run, std::uint32_t(&beside - runs_.all().data()));
    }
}

void Cavities::judge(const SolidFill& crossings, const Outside& outside) {
    runs_.sort();
    const std::span<const VoxelRun> runs = runs_.all();
    parents_.resize(runs.size());
    std::iota(parents_.begin(), parents_.end(), 0U);
    std::vector<Walls> walls(runs.size());
    const Prober prober(crossings, outside, runs_);
    tbb::parallel_for(std::size_t(0), runs.size(), [&](std::size_t i) { walls[i] = prober.behind(runs[i]); });
    for (std::uint32_t run = 0; run < runs.size(); ++run) {
        const glm::ivec3& first = runs[run].first;
        join_with_row(run, first.y + 1, first.z);
        join_with_row(run, first.y, first.z + 1);
    }
    for (std::uint32_t run = 0; run < runs.size(); ++run) {
        if (const std::uint32_t part = part_of(run); part != run) walls[part].add(walls[run]);
    }
    is_doubtful_.resize(runs.size());
    for (std::uint32_t run = 0; run < runs.size(); ++run)
        is_doubtful_[run] = walls[part_of(run)].give_doubt();
}

std::uint64_t Cavities::doubtful_voxels() const {
    std::uint64_t sum = 0;
    for (std::size_t run = 0; run < is_doubtful_.size(); ++run)
        sum += is_doubtful_[run] ? std::uint64_t(runs_.all()[run].length) : 0;
    return sum;
}

void Cavities::copy_doubtful(const glm::ivec3& tile_origin, BitGrid& tile) const {
    runs_.copy_to(tile_origin, tile, [this](std::size_t run) { return bool(is_doubtful_[run]); });
}

}  // namespace cairn::voxelizer

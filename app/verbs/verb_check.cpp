#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "app/terminal/interrupt.h"
#include "app/terminal/measure.h"
#include "app/terminal/progress.h"
#include "app/terminal/report.h"
#include "app/verbs/verbs.h"
#include "app/verbs/voxelization.h"
#include "base/error.h"
#include "reference/exact_voxels.h"

namespace cairn::app {
namespace {

/// Compares tiles with the truth as they arrive, in the order of VoxelWriter. Tiles that do not arrive must
/// be empty in the truth too.
class TileComparison {
public:
    TileComparison(const voxelizer::Surface& surface, const voxelizer::Grid& grid, bool quiet)
        : truth_(surface),
          grid_(grid),
          counts_(voxelizer::tile_counts(grid)),
          progress_(std::in_place, "checking", quiet) {}

    void add(const voxelizer::VoxelTile& tile) {
        const glm::ivec3 place = tile.origin / voxelizer::VOXEL_TILE_SIDE;
        skip_to((std::int64_t(place.x) * counts_.z + place.z) * counts_.y + place.y);
        compare(tile);
        ++next_;
    }
    void finish() {
        skip_to(std::int64_t(counts_.x) * counts_.y * counts_.z);
        progress_.reset();
    }

    struct Different {
        glm::ivec3 voxel;
        bool extra;
    };
    [[nodiscard]] std::uint64_t missing() const { return missing_; }
    [[nodiscard]] std::uint64_t extra() const { return extra_; }
    [[nodiscard]] const std::vector<Different>& first_different() const { return first_different_; }

private:
    void skip_to(std::int64_t number) {
        for (; next_ < number; ++next_) {
            const glm::ivec3 place(next_ / (std::int64_t(counts_.y) * counts_.z), next_ % counts_.y,
                                   next_ / counts_.y % counts_.z);
            const glm::ivec3 origin = place * voxelizer::VOXEL_TILE_SIDE;
            const glm::ivec3 size =
                glm::min(glm::ivec3(voxelizer::VOXEL_TILE_SIDE), grid_.resolution - origin);
            compare({origin, voxelizer::BitGrid(size), {}});
        }
    }
    void compare(const voxelizer::VoxelTile& tile) {
        Interrupt::check();
        progress_->set(double(next_) / (double(counts_.x) * counts_.y * counts_.z));
        const reference::Comparison comparison =
            reference::compare(tile.bits, truth_.in({grid_.level(), tile.origin, tile.bits.size}));
        missing_ += comparison.missing;
        extra_ += comparison.extra;
        for (const glm::ivec3& voxel : comparison.first_different) {
            if (first_different_.size() < 8)
                first_different_.push_back({tile.origin + voxel, tile.bits.at(voxel)});
        }
    }

    reference::ExactVoxels truth_;
    voxelizer::Grid grid_;
    glm::ivec3 counts_;
    std::optional<Progress> progress_;
    std::int64_t next_ = 0;  ///< number of the tile to compare next
    std::uint64_t missing_ = 0;
    std::uint64_t extra_ = 0;
    std::vector<Different> first_different_;
};

/// @return milliseconds that the truth and the comparison took
double compare_all(Voxelization& voxelization, TileComparison& comparison) {
    double reference_ms = 0.0;
    voxelization.run(
        [&](voxelizer::VoxelTile&& tile) {
            Stopwatch watch;
            comparison.add(tile);
            reference_ms += watch.lap_ms();
        },
        [](double) { return true; });
    Stopwatch watch;
    comparison.finish();
    return reference_ms + watch.lap_ms();
}

ExitCode run(const VoxelizationOptions& options) {
    Report report(options.common.report);
    GriddedInput scene = load_gridded(options);
    Voxelization voxelization(options, std::move(scene), {.surface = true});
    Stopwatch watch;
    TileComparison comparison(voxelization.surface(), voxelization.grid(), options.common.report.quiet);
    const double prepare_ms = watch.lap_ms();
    const double reference_ms = prepare_ms + compare_all(voxelization, comparison);

    voxelization.report(report);
    report.add("reference_ms", reference_ms);
    report.add("missing", comparison.missing());
    report.add("extra", comparison.extra());
    if (!comparison.first_different().empty()) {
        Json first = Json::array();
        for (const auto& [voxel, extra] : comparison.first_different())
            first.push_back({{"voxel", json_of(voxel)}, {"is", extra ? "extra" : "missing"}});
        report.add("first_different", std::move(first));
    }
    report.add("peak_rss_bytes", peak_rss_bytes());
    report.finish();
    return comparison.missing() == 0 && comparison.extra() == 0 ? ExitCode::done : ExitCode::differs;
}

}  // namespace

void add_check(CLI::App& command, Work& chosen) {
    add_verb<VoxelizationOptions>(command, chosen, "check", "Voxelize, and compare with the exact reference",
                                  add_voxelization_options, run);
}

}  // namespace cairn::app

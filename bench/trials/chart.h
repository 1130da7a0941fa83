#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/plots/table.h"
#include "bench/trials/voxel_options.h"
#include "gl/shader_source.h"

namespace cairn::bench {

/// What a chart is asked for.
struct ChartOptions {
    /// Where the files go; made if need be.
    std::filesystem::path folder = ".";
    /// Paths and builtin:NAMEs; empty: the chart's own choice.
    std::vector<std::string> scenes;
    /// Where to look for the real scenes among the chart's own choice; none: they are left out.
    std::optional<std::filesystem::path> scene_folder;
    /// Voxels per side, or pixels; empty: the chart's own choice.
    std::vector<int> resolutions;
    /// Pixels from left to right, where `resolutions` are voxels; none: the chart's own choice.
    std::optional<int> width;
    int runs = 7;  ///< of each contender, in turn; at least 1
    /// A contender is not run again once it has taken so long at one size.
    double budget_ms = 3000.0;
    /// Keeps what Embree found of soft lights, which takes long; none: found anew.
    std::optional<std::filesystem::path> truth_cache;
    VoxelOptions voxels;
    gl::ShaderSource shaders;
    /// Called with the share done, in [0, 1]; may be empty.
    std::function<void(double)> progress;
};

/// What a chart has measured.
struct Chart {
    Table table;
    std::vector<std::filesystem::path> files;  ///< written
    std::vector<std::string> notes;            ///< what was left out, and why
    bool differs = false;                      ///< a comparison with the truth found a difference
};

}  // namespace cairn::bench

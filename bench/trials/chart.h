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

/// Options of a chart.
struct ChartOptions {
    /// Folder for the files; created if need be.
    std::filesystem::path folder = ".";
    /// Scenes, by paths and builtin:NAMEs; empty: the chart's own choice.
    std::vector<std::string> scenes;
    /// Folder of the real scenes of the chart's own choice; none: they are left out.
    std::optional<std::filesystem::path> scene_folder;
    /// Voxels per side, or pixels; empty: the chart's own choice.
    std::vector<int> resolutions;
    /// Width of pictures in pixels if `resolutions` are voxels; none: the chart's own choice.
    std::optional<int> width;
    int runs = 7;  ///< runs per contender, in turn; at least 1
    /// Milliseconds after which a contender is not run again at one size.
    double budget_ms = 3000.0;
    /// Folder that keeps Embree's shares of soft lights, which take long; none: they are computed each time.
    std::optional<std::filesystem::path> truth_cache;
    VoxelOptions voxels;
    gl::ShaderSource shaders;
    /// Called with the share done, in [0, 1]; may be empty.
    std::function<void(double)> progress;
};

/// Results of a chart.
struct Chart {
    Table table;
    std::vector<std::filesystem::path> files;  ///< files that were written
    std::vector<std::string> notes;            ///< parts that were left out, with the reasons
    bool differs = false;                      ///< a comparison with the truth found a difference
};

}  // namespace cairn::bench

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/trials/chart.h"
#include "bench/trials/shadow_runs.h"
#include "bench/trials/shadow_scene.h"
#include "reference/image.h"
#include "reference/shadow_truth.h"

namespace cairn::bench {

/// Voxels of one scene, kept from one case to the next. The key is the number of voxels per side that rays
/// meet; none: the level is chosen per pixel.
using KeptVoxels = std::map<std::optional<int>, std::unique_ptr<ShadowFrames>>;

/// The question to all contenders: the share of the light that arrives at each pixel of a picture.
struct ShadowCase {
    const ShadowScene& scene;
    int width = 512;
    int height = 384;
    bool is_soft = true;  ///< whole light; false: its middle alone
    const reference::ImageTracer& tracer;
    const reference::ShadowReceivers& receivers;  ///< pixels that are compared
    KeptVoxels& voxels;
    const ChartOptions& options;
};

/// The parameters of a contender, as columns of the table; empty if they do not apply to its method.
struct ShadowSetting {
    /// The parameter that varies along a line of the picture.
    std::string varied;
    std::optional<int> rays = std::nullopt;  ///< rays per pixel
    /// Voxels per side that rays meet; none: the level is chosen per pixel.
    std::optional<int> resolution = std::nullopt;
    std::optional<int> map_size = std::nullopt;  ///< texels per side of a map
    std::optional<int> kernel = std::nullopt;    ///< taps per axis
    std::optional<int> samples = std::nullopt;   ///< samples of the light per pixel, on the CPU
    std::string passes = {}, format = {};        ///< options of a soft shadow map
};

/// A method with its setting. To add a method, add a function to the table in shadow_contenders.cpp.
struct ShadowContender {
    std::string method;
    ShadowSetting setting;
    bool is_ours = true;
    bool ground_only = false;  ///< finds no shadows of casters on casters
    std::function<ShadowRun()> run;
};
/// All contenders of a case, which must outlive them; along a line from cheap to expensive.
[[nodiscard]] std::vector<ShadowContender> shadow_contenders(const ShadowCase& shadow_case);

}  // namespace cairn::bench

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

/// What voxels of one scene are kept in, from one case to the next: by the voxels a side that rays meet, or
/// by what a pixel shows.
using KeptVoxels = std::map<std::optional<int>, std::unique_ptr<ShadowFrames>>;

/// What all contenders are asked: what of the light arrives at each pixel of a picture.
struct ShadowCase {
    const ShadowScene& scene;
    int width = 512;
    int height = 384;
    bool is_soft = true;  ///< else of its middle
    const reference::ImageTracer& tracer;
    const reference::ShadowReceivers& receivers;  ///< the pixels that count
    KeptVoxels& voxels;
    const ChartOptions& options;
};

/// What a table says of a contender, beside its method; nothing where it does not apply.
struct ShadowSetting {
    std::string varied;                      ///< what differs along a line of the picture
    std::optional<int> rays = std::nullopt;  ///< a pixel
    std::optional<int> resolution =
        std::nullopt;  ///< voxels a side that rays meet; none: by what a pixel shows
    std::optional<int> map_size = std::nullopt;  ///< texels a side
    std::optional<int> kernel = std::nullopt;    ///< taps an axis
    std::optional<int> samples = std::nullopt;   ///< of the light, a pixel, on the CPU
    std::string passes = {}, format = {};        ///< of a soft shadow map
};

/// A way to a shadow, in one setting. A new one is a function in the table of shadow_contenders.cpp.
struct ShadowContender {
    std::string method;
    ShadowSetting setting;
    bool is_ours = true;
    bool ground_only = false;  ///< knows no shadow of what throws it on itself
    std::function<ShadowRun()> run;
};
/// All of them for one case, which must outlive them; within a line from cheap to dear.
[[nodiscard]] std::vector<ShadowContender> shadow_contenders(const ShadowCase& shadow_case);

}  // namespace cairn::bench

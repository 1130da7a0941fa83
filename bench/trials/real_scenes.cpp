#include "bench/trials/real_scenes.h"

namespace cairn::bench {

void add_real_scenes(Chart& chart, const ChartOptions& options, std::initializer_list<const char*> names,
                     std::vector<std::string>& scenes) {
    for (const std::filesystem::path name : names) {
        if (name.is_relative() && !options.scene_folder) {
            chart.notes.push_back(name.string() + " is left out: no --scenes folder was given");
            continue;
        }
        const std::filesystem::path path = name.is_relative() ? *options.scene_folder / name : name;
        if (std::filesystem::exists(path)) {
            scenes.push_back(path.string());
        } else {
            chart.notes.push_back(path.string() + " is not there, and left out");
        }
    }
}

std::string scene_name(const std::string& scene) {
    return scene.starts_with("builtin:") ? scene.substr(scene.find(':') + 1)
                                         : std::filesystem::path(scene).stem().string();
}

}  // namespace cairn::bench

// `cairn check` over every scene there is: the conservative method against the exact reference, bit by bit.
//
//     check_scenes OUT_FOLDER SCENE_FOLDER [RESOLUTION ...]
//
// Every .gltf and .glb under SCENE_FOLDER and every built-in scene, at rest and, where it has an animation,
// in the middle of its first one, at 64, 128, 256 and 512 unless told otherwise. Each check is a process of
// its own, one at a time, ended after five minutes and then reported as such. Prints a line for each and
// keeps OUT_FOLDER/check.csv up to date while it runs. Exit code 1 when any check found a difference or did
// not end.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "base/error.h"
#include "scenes/builtin/builtin.h"
#include "scenes/load.h"

namespace {

using namespace cairn;

constexpr int limit_seconds = 300;
constexpr int exit_code_of_limit = 124;  // timeout(1)

struct Check {
    std::string scene;                        ///< what the command is given
    std::string name;                         ///< what the table says
    std::optional<double> animation_seconds;  ///< into its first animation; none: at rest
    int resolution = 0;
};

std::vector<Check> checks_of(const std::string& scene, const std::string& name,
                             const std::vector<int>& resolutions) {
    std::vector<std::optional<double>> moments = {std::nullopt};
    const scenes::Scene loaded = scenes::load(scene);
    if (!loaded.animations.empty()) moments.emplace_back(0.5 * loaded.animations[0].duration);
    std::vector<Check> out;
    for (const std::optional<double>& moment : moments) {
        for (const int resolution : resolutions)
            out.push_back({scene, name, moment, resolution});
    }
    return out;
}

std::vector<Check> all_checks(const std::filesystem::path& folder, const std::vector<int>& resolutions) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::filesystem::path extension = entry.path().extension();
        if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    std::vector<Check> out;
    const auto add = [&](const std::string& scene, const std::string& name) {
        const std::vector<Check> more = checks_of(scene, name, resolutions);
        out.insert(out.end(), more.begin(), more.end());
    };
    for (const scenes::Builtin& builtin : scenes::builtins()) {
        const std::string scene = fmt::format("builtin:{}", builtin.name);
        add(scene, scene);
    }
    for (const std::filesystem::path& file : files)
        add(file.string(), std::filesystem::relative(file, folder).string());
    return out;
}

/// For the shell: everything but the quote itself is literal between single quotes.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') out += "'\\'";
        out += c;
    }
    return out + '\'';
}

struct Outcome {
    std::string word;  ///< same, differs, limit, or failed
    nlohmann::json figures = nlohmann::json::object();
    double seconds = 0.0;
};

Outcome run(const Check& check, const std::filesystem::path& json) {
    std::filesystem::remove(json);
    std::string line =
        fmt::format("timeout {} {} check {} -r {} --quiet --json {}", limit_seconds, quoted(CAIRN_COMMAND),
                    quoted(check.scene), check.resolution, quoted(json.string()));
    if (check.animation_seconds)
        line += fmt::format(" --animation 0 --time {:.6f}", *check.animation_seconds);
    const auto start = std::chrono::steady_clock::now();
    const int status = std::system(line.c_str());
    Outcome out;
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    out.word = code == 0 ? "same" : code == 1 ? "differs" : code == exit_code_of_limit ? "limit" : "failed";
    std::ifstream stream(json);
    if (stream) out.figures = nlohmann::json::parse(stream, nullptr, false);
    std::filesystem::remove(json);
    return out;
}

std::string row_of(const Check& check, const Outcome& outcome) {
    const auto figure = [&](const char* key) {
        return outcome.figures.contains(key) ? outcome.figures[key].dump() : std::string();
    };
    const std::string moment = check.animation_seconds ? fmt::format("{:.3f}", *check.animation_seconds) : "";
    return fmt::format("\"{}\",{},{},{},{},{},{},{},{:.2f},{}", check.name, moment, check.resolution,
                       figure("triangles"), figure("occupied"), figure("missing"), figure("extra"),
                       outcome.word, outcome.seconds, figure("driver"));
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 3) {
        fmt::print(stderr, "usage: check_scenes OUT_FOLDER SCENE_FOLDER [RESOLUTION ...]\n");
        return 2;
    }
    std::vector<int> resolutions;
    for (int i = 3; i < argc; ++i)
        resolutions.push_back(std::atoi(argv[i]));
    if (resolutions.empty()) resolutions = {64, 128, 256, 512};
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "check.csv");
    csv << "scene,animation_seconds,resolution,triangles,occupied,missing,extra,outcome,seconds,driver\n";
    int not_same = 0;
    const std::vector<Check> checks = all_checks(argv[2], resolutions);
    for (const Check& check : checks) {
        const Outcome outcome = run(check, folder / "check.json");
        not_same += outcome.word == "same" ? 0 : 1;
        const std::string row = row_of(check, outcome);
        fmt::print("{}\n", row);
        std::fflush(stdout);
        csv << row << std::endl;
    }
    fmt::print("{} checks, {} not the same\n", checks.size(), not_same);
    return csv && not_same == 0 ? 0 : 1;
} catch (const cairn::Error& error) {
    fmt::print(stderr, "error: {}\n  {}\n", error.what(), error.way_out());
    return 2;
}

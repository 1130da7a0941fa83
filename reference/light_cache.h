#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/shadow_truth.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {

/// All arguments that an answer of area_light_visibility() depends on.
struct LightQuestion {
    const scenes::Scene& scene;
    const scenes::Snapshot& snapshot;
    std::span<const glm::dvec3> points;
    std::span<const glm::dvec3> normals;
    const optics::Light& light;
    const AreaLightOptions& options;
};
using LightHash = std::array<std::uint64_t, 2>;
/// The XXH3 hash of a question, 128 bits. It leaves out what cannot change the answer: colours, names,
/// threads.
[[nodiscard]] LightHash hash_of(const LightQuestion& question);

/// Keeps one answer in a file of a folder, whose name is the hash of the question.
class LightCache {
public:
    /// Creates the folder. @throws Error  Fault::usage if that fails.
    LightCache(const std::filesystem::path& folder, const LightHash& hash);

    /// The answer; nothing if there is no file, or the file is not whole.
    [[nodiscard]] std::optional<std::vector<LightVisibility>> load(std::size_t points) const;
    /// @throws Error  as OutputFile does.
    void save(std::span<const LightVisibility> answer) const;

private:
    std::filesystem::path path_;
};

}  // namespace cairn::reference

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/area_light.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {

/// All that an answer of area_light_visibility() depends on.
struct LightQuestion {
    const scenes::Scene& scene;
    const scenes::Snapshot& snapshot;
    std::span<const glm::dvec3> points;
    std::span<const glm::dvec3> normals;
    const optics::Light& light;
    const AreaLightOptions& options;
};
using LightHash = std::array<std::uint64_t, 2>;
/// XXH3, 128 bits. What cannot change the answer does not change it: colours, names, threads.
[[nodiscard]] LightHash hash_of(const LightQuestion& question);

/// One answer in a file of a folder, under its question's hash.
class LightCache {
public:
    /// Makes the folder. @throws Error  Fault::usage when it cannot.
    LightCache(const std::filesystem::path& folder, const LightHash& hash);

    /// Nothing when there is no file, or it is not whole.
    [[nodiscard]] std::optional<std::vector<LightVisibility>> load(std::size_t points) const;
    /// @throws Error  as OutputFile does.
    void save(std::span<const LightVisibility> answer) const;

private:
    std::filesystem::path path_;
};

}  // namespace cairn::reference

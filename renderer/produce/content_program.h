#pragma once

#include <functional>
#include <string>

namespace cairn::renderer {

/// How rays see a kind of content: the shaders that march it, and what they need beside the pools.
struct ContentProgram {
    std::string primary = "march/primary.comp.glsl";
    std::string shadow = "march/shadow.comp.glsl";
    /// Steps in which a ray crosses a voxel of a volume, at least 1; 0: the content is a surface, whose
    /// shadow rays know SHOW_LIGHT and cones.
    int volume_steps = 0;
    /// Tiles may hold one value that is not 0, without a brick.
    bool has_constant = false;
    /// Tiles may have nothing finer to show.
    bool has_final = false;
    /// Called before each pass; may be empty.
    std::function<void()> bind = nullptr;
    [[nodiscard]] bool of_surfaces() const { return volume_steps == 0; }
};

}  // namespace cairn::renderer

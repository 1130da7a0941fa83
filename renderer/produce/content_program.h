#pragma once

#include <functional>
#include <string>

#include "gl/shader_source.h"

namespace cairn::renderer {

/// How rays see a kind of content: the shaders that march it, and what they need beside the pools.
struct ContentProgram {
    std::string primary = "march/primary.comp.glsl";
    std::string shadow = "march/shadow.comp.glsl";
    gl::Defines defines;
    /// Called before each pass; may be empty.
    std::function<void()> bind;
    /// The content is a surface, whose shadow rays know SHOW_LIGHT and cones.
    bool of_surfaces = true;
};

}  // namespace cairn::renderer

#pragma once

#include <memory>
#include <string>

#include <glm/glm.hpp>

#include "gl/context.h"

struct GLFWwindow;

namespace cairn::gl {

/// A window with an OpenGL 4.5 core context (GLFW). There can be one window at a time, on the main thread, as
/// GLFW asks.
class Window : public Context {
public:
    /// The GLFW handle, for input callbacks.
    [[nodiscard]] virtual GLFWwindow* native() const = 0;
    [[nodiscard]] virtual glm::ivec2 framebuffer_size() const = 0;
    [[nodiscard]] virtual bool should_close() const = 0;
    virtual void swap_and_poll() = 0;
};

/// @throws Error (Fault::context) if there is no display, or its driver offers no OpenGL 4.5.
[[nodiscard]] std::unique_ptr<Window> create_window(const std::string& title, glm::ivec2 size,
                                                    bool debug = false);

}  // namespace cairn::gl

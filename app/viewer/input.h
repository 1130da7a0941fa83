#pragma once

#include <exception>
#include <functional>
#include <utility>

#include <glm/glm.hpp>

#include "app/viewer/viewer.h"

struct GLFWwindow;

namespace cairn::app {

/// Passes keys and mouse of a GLFW window on to a viewer, from construction to destruction. At most one per
/// window at a time.
class Input {
public:
    Input(GLFWwindow* window, Viewer& viewer);
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;
    Input(Input&&) = delete;
    Input& operator=(Input&&) = delete;
    ~Input();

    /// Handles the events that wait, or waits for one for up to `seconds`.
    /// @throws what a handler threw. It is kept until GLFW returns: exceptions must not pass through GLFW.
    void take_events(double seconds);

    [[nodiscard]] bool wants_help() const { return help_; }
    /// Whether anything has happened since the last call, so that the window is to be drawn again.
    [[nodiscard]] bool take_stir() { return std::exchange(stir_, false); }

private:
    static Input& of(GLFWwindow* window);
    void guarded(const std::function<void()>& answer) noexcept;
    void on_key(int key, int scancode, int action);
    void on_character(unsigned character);
    void on_cursor(const glm::dvec2& place);
    [[nodiscard]] glm::dvec3 ways() const;

    GLFWwindow* window_;
    Viewer& viewer_;
    glm::dvec2 cursor_{0.0};
    bool help_ = false;
    bool stir_ = true;
    std::exception_ptr failure_;
};

}  // namespace cairn::app

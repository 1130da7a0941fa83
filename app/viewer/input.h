#pragma once

#include <exception>
#include <functional>
#include <utility>

#include <glm/glm.hpp>

#include "app/viewer/viewer.h"

struct GLFWwindow;

namespace cairn::app {

/// Keys and mouse of a GLFW window, as the viewer takes them. One for each window, as long as it listens.
class Input {
public:
    Input(GLFWwindow* window, Viewer& viewer);
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;
    Input(Input&&) = delete;
    Input& operator=(Input&&) = delete;
    ~Input();

    /// Takes the events that wait, or waits for one as long as `seconds`.
    /// @throws what went wrong in answering them: an exception must not pass through GLFW's own frames.
    void take_events(double seconds);

    [[nodiscard]] bool wants_help() const { return help_; }
    /// Something happened since the last call: the window is to be drawn again.
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

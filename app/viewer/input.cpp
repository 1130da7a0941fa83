#include "app/viewer/input.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace cairn::app {
namespace {

glm::dvec2 cursor_of(GLFWwindow* window) {
    glm::dvec2 place;
    glfwGetCursorPos(window, &place.x, &place.y);
    return place;
}

}  // namespace

Input& Input::of(GLFWwindow* window) {
    return *static_cast<Input*>(glfwGetWindowUserPointer(window));
}

Input::Input(GLFWwindow* window, Viewer& viewer)
    : window_(window), viewer_(viewer), cursor_(cursor_of(window)) {
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int) {
        of(w).guarded([=] { of(w).on_key(key, scancode, action); });
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
        of(w).guarded([=] { of(w).on_character(character); });
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        of(w).guarded([=] { of(w).on_cursor({x, y}); });
    });
    glfwSetScrollCallback(
        window, [](GLFWwindow* w, double, double y) { of(w).guarded([=] { of(w).viewer_.wheel(y); }); });
    glfwSetMouseButtonCallback(
        window, [](GLFWwindow* w, int, int, int) { of(w).guarded([=] { of(w).cursor_ = cursor_of(w); }); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int width, int height) {
        of(w).guarded([=] { of(w).viewer_.resize({width, height}); });
    });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).guarded([] {}); });
}

Input::~Input() {
    glfwSetKeyCallback(window_, nullptr);
    glfwSetCharCallback(window_, nullptr);
    glfwSetCursorPosCallback(window_, nullptr);
    glfwSetScrollCallback(window_, nullptr);
    glfwSetMouseButtonCallback(window_, nullptr);
    glfwSetFramebufferSizeCallback(window_, nullptr);
    glfwSetWindowRefreshCallback(window_, nullptr);
}

void Input::guarded(const std::function<void()>& answer) noexcept {
    stir_ = true;
    try {
        answer();
    } catch (...) {
        failure_ = std::current_exception();
    }
}

void Input::take_events(double seconds) {
    if (seconds > 0.0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
    viewer_.fly(ways());
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// Letters are those of the keyboard's layout.
void Input::on_key(int key, int scancode, int action) {
    if (action != GLFW_PRESS) return;
    if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window_, GLFW_TRUE);
    if (key == GLFW_KEY_HOME) viewer_.command(Command::reset_camera);
    if (key == GLFW_KEY_F1) help_ = !help_;
    const char* const name = glfwGetKeyName(key, scancode);
    switch (name != nullptr ? name[0] : '\0') {
        case 'r':
            return viewer_.command(Command::reset_camera);
        case 'f':
            return viewer_.command(Command::toggle_fly);
        case 'l':
            return viewer_.command(Command::next_show);
        case 'h':
            return viewer_.command(Command::toggle_shadow);
        case 'p':
            return viewer_.command(Command::take_picture);
        default:
            return;
    }
}

void Input::on_character(unsigned character) {
    if (character == '?') help_ = !help_;
    if (character == '[' || character == '+') viewer_.command(Command::finer);
    if (character == ']' || character == '-') viewer_.command(Command::coarser);
}

void Input::on_cursor(const glm::dvec2& place) {
    glm::ivec2 size;
    glfwGetWindowSize(window_, &size.x, &size.y);
    const glm::dvec2 moved = (place - std::exchange(cursor_, place)) / double(std::max(size.y, 1));
    const auto held = [this](int button) { return glfwGetMouseButton(window_, button) == GLFW_PRESS; };
    if (held(GLFW_MOUSE_BUTTON_LEFT)) {
        viewer_.drag_left(moved);
    } else if (held(GLFW_MOUSE_BUTTON_RIGHT) || held(GLFW_MOUSE_BUTTON_MIDDLE)) {
        viewer_.drag_right(moved);
    }
}

/// Keys are identified by their places, whatever their letters.
glm::dvec3 Input::ways() const {
    const auto held = [this](int key) { return glfwGetKey(window_, key) == GLFW_PRESS ? 1.0 : 0.0; };
    return {held(GLFW_KEY_D) - held(GLFW_KEY_A), held(GLFW_KEY_E) - held(GLFW_KEY_Q),
            held(GLFW_KEY_W) - held(GLFW_KEY_S)};
}

}  // namespace cairn::app

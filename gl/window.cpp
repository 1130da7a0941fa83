#include "gl/window.h"

#include <string>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/error.h"

namespace cairn::gl {
namespace {

[[noreturn]] void refuse(const char* what) {
    const char* detail = nullptr;
    glfwGetError(&detail);
    throw Error(Fault::context, "GLFW",
                std::string(what) + (detail != nullptr ? std::string(": ") + detail : ""),
                "without a display use create_context(), which needs no window");
}

class GlfwWindow final : public Window {
public:
    GlfwWindow(const std::string& title, glm::ivec2 size, bool debug) {
        if (glfwInit() != GLFW_TRUE) refuse("no window system");
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, debug ? GLFW_TRUE : GLFW_FALSE);
        window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
        if (window_ == nullptr) {
            try {
                refuse("no window with OpenGL 4.5 core");
            } catch (...) {
                glfwTerminate();
                throw;
            }
        }
        try {
            GlfwWindow::make_current();
            load_functions(reinterpret_cast<void* (*)(const char*)>(glfwGetProcAddress), debug);
        } catch (...) {
            destroy();
            throw;
        }
    }
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;
    GlfwWindow(GlfwWindow&&) = delete;
    GlfwWindow& operator=(GlfwWindow&&) = delete;
    ~GlfwWindow() override { destroy(); }

    void make_current() override { glfwMakeContextCurrent(window_); }
    [[nodiscard]] std::string_view backend() const override { return "glfw"; }
    [[nodiscard]] GLFWwindow* native() const override { return window_; }
    [[nodiscard]] bool should_close() const override { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
    [[nodiscard]] glm::ivec2 framebuffer_size() const override {
        glm::ivec2 size;
        glfwGetFramebufferSize(window_, &size.x, &size.y);
        return size;
    }
    void swap_and_poll() override {
        glfwSwapBuffers(window_);
        glfwPollEvents();
    }

private:
    void destroy() {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }
    GLFWwindow* window_ = nullptr;
};

}  // namespace

std::unique_ptr<Window> create_window(const std::string& title, glm::ivec2 size, bool debug) {
    return std::make_unique<GlfwWindow>(title, size, debug);
}

}  // namespace cairn::gl

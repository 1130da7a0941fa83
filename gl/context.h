#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::gl {

/// The messages of KHR_debug about errors and undefined behaviour in the current context.
class DebugLog {
public:
    DebugLog() = default;
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;
    DebugLog(DebugLog&&) = delete;
    DebugLog& operator=(DebugLog&&) = delete;
    ~DebugLog() = default;

    /// Starts listening to the current context; the log must outlive it.
    void attach();

    /// Returns and removes the messages gathered so far, and the errors that glGetError still holds.
    [[nodiscard]] std::vector<std::string> take();

    void add(std::string message);

private:
    std::mutex mutex_;  // a driver may report from a thread of its own
    std::vector<std::string> messages_;
};

enum class ContextKind {
    /// EGL if it offers hardware, else OSMesa, else EGL's software driver.
    automatic,
    osmesa,  ///< Mesa's off-screen software rasterizer
    egl,     ///< no window: a device, or Mesa's surfaceless platform
};

struct ContextOptions {
    ContextKind kind = ContextKind::automatic;
    /// Turns KHR_debug on: `Context::debug_log` gathers errors and undefined behaviour.
    bool debug = false;
};

/// An OpenGL 4.5 core context with no window. The context is current on the thread that created it until it
/// is destroyed.
///
/// OSMesa and EGL are opened with dlopen when they are asked for, so one binary runs where either is absent.
class Context {
public:
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    Context(Context&&) = delete;
    Context& operator=(Context&&) = delete;
    virtual ~Context() = default;

    virtual void make_current() = 0;

    /// "osmesa", "egl", "glfw" or "adopted".
    [[nodiscard]] virtual std::string_view backend() const = 0;
    [[nodiscard]] DebugLog& debug_log() { return *debug_log_; }

protected:
    Context() = default;
    /// Loads the OpenGL functions and checks the version. @throws Error (Fault::context) naming the driver.
    void load_functions(void* (*get_proc_address)(const char*), bool debug);

private:
    std::unique_ptr<DebugLog> debug_log_ = std::make_unique<DebugLog>();
};

/// @throws Error  Fault::context if no library offers OpenGL 4.5; the message says which were tried and what
///                each offers. Fault::memory if that is for lack of memory.
[[nodiscard]] std::unique_ptr<Context> create_context(const ContextOptions& options = {});

/// For a program that has a context already: loads the OpenGL functions for the current context, which must
/// outlive everything that is made while it is current. The context stays the caller's:
/// Context::make_current() does nothing, and the destructor leaves the context as it is. One context can be
/// adopted at a time.
///
/// Rendering and voxelizing leave the caller's framebuffer, viewport, blending, tests and vertex array as
/// they were (gl/draw_state.h has the list). They change the current program, the buffers bound to indexed
/// targets, and what is bound to texture and image units: a caller binds its own again, as it does for each
/// of its passes.
/// @param get_proc_address  the window system's function: glfwGetProcAddress, eglGetProcAddress, ...
/// @throws Error  Fault::context if no context is current, or the current one is older than OpenGL 4.5.
[[nodiscard]] std::unique_ptr<Context> adopt_context(void* (*get_proc_address)(const char*));

/// GL_RENDERER and the version of the current context: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 (Core
/// Profile) Mesa 22.3.6".
[[nodiscard]] std::string driver_name();

/// Whether the current context rasterizes on the CPU: its times say nothing about a GPU.
[[nodiscard]] bool is_software_driver();

}  // namespace cairn::gl

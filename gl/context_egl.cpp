#include <array>
#include <string>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/context_backends.h"
#include "gl/dynamic_library.h"

namespace cairn::gl {
namespace {

/// The few EGL functions that a context without a surface needs.
struct Egl {
    Egl()
        : library({"libEGL.so.1", "libEGL.so"}, "libegl1"),
          get_proc_address(library.function<decltype(&eglGetProcAddress)>("eglGetProcAddress")),
          get_error(library.function<decltype(&eglGetError)>("eglGetError")),
          query_string(library.function<decltype(&eglQueryString)>("eglQueryString")),
          initialize(library.function<decltype(&eglInitialize)>("eglInitialize")),
          terminate(library.function<decltype(&eglTerminate)>("eglTerminate")),
          bind_api(library.function<decltype(&eglBindAPI)>("eglBindAPI")),
          create_context(library.function<decltype(&eglCreateContext)>("eglCreateContext")),
          destroy_context(library.function<decltype(&eglDestroyContext)>("eglDestroyContext")),
          make_current(library.function<decltype(&eglMakeCurrent)>("eglMakeCurrent")) {}

    template <typename Function>
    [[nodiscard]] Function extension(const char* name) const {
        return reinterpret_cast<Function>(get_proc_address(name));
    }
    [[nodiscard]] bool client_has(std::string_view name) const {
        const char* all = query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
        return all != nullptr && std::string_view(all).find(name) != std::string_view::npos;
    }

    DynamicLibrary library;
    decltype(&eglGetProcAddress) get_proc_address;
    decltype(&eglGetError) get_error;
    decltype(&eglQueryString) query_string;
    decltype(&eglInitialize) initialize;
    decltype(&eglTerminate) terminate;
    decltype(&eglBindAPI) bind_api;
    decltype(&eglCreateContext) create_context;
    decltype(&eglDestroyContext) destroy_context;
    decltype(&eglMakeCurrent) make_current;
};

/// Displays that need no window system: each device of EGL, then Mesa's surfaceless platform.
std::vector<EGLDisplay> candidate_displays(const Egl& egl) {
    std::vector<EGLDisplay> displays;
    const auto get_display = egl.extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (get_display == nullptr) return displays;
    auto add = [&](EGLenum platform, void* native) {
        EGLDisplay display = get_display(platform, native, nullptr);
        if (display != EGL_NO_DISPLAY) displays.push_back(display);
    };
    if (egl.client_has("EGL_EXT_platform_device") || egl.client_has("EGL_EXT_device_enumeration")) {
        const auto query = egl.extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (query != nullptr && query(EGLint(devices.size()), devices.data(), &count) == EGL_TRUE) {
            for (EGLint i = 0; i < count; ++i)
                add(EGL_PLATFORM_DEVICE_EXT, devices[std::size_t(i)]);
        }
    }
    if (egl.client_has("EGL_MESA_platform_surfaceless"))
        add(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
    return displays;
}

class EglContext final : public Context {
public:
    EglContext(const Egl& egl, EGLDisplay display, bool debug) : egl_(egl), display_(display) {
        if (egl_.initialize(display_, nullptr, nullptr) != EGL_TRUE) refuse("the display does not start");
        try {
            create(debug);
        } catch (...) {
            destroy();
            throw;
        }
    }
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;
    EglContext(EglContext&&) = delete;
    EglContext& operator=(EglContext&&) = delete;
    ~EglContext() override { destroy(); }

    void make_current() override {
        if (egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
            refuse("a context without a surface cannot be made current");
        }
    }
    [[nodiscard]] std::string_view backend() const override { return "egl"; }

private:
    [[noreturn]] void refuse(const char* what) const {
        throw Error(Fault::context, "EGL", fmt::format("{} (error {:#x})", what, egl_.get_error()),
                    "choose ContextOptions::kind osmesa");
    }

    void create(bool debug) {
        if (egl_.bind_api(EGL_OPENGL_API) != EGL_TRUE) refuse("it offers no desktop OpenGL");
        std::vector<EGLint> attributes = {
            EGL_CONTEXT_MAJOR_VERSION,       4,
            EGL_CONTEXT_MINOR_VERSION,       5,
            EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
        if (debug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
        attributes.push_back(EGL_NONE);
        context_ = egl_.create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        // Without 4.5, whatever there is can at least say its name: load_functions refuses it with that.
        const std::array<EGLint, 1> any = {EGL_NONE};
        if (context_ == EGL_NO_CONTEXT) {
            context_ = egl_.create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, any.data());
        }
        if (context_ == EGL_NO_CONTEXT) refuse("it offers no OpenGL 4.5 core context");
        EglContext::make_current();
        load_functions(reinterpret_cast<void* (*)(const char*)>(egl_.get_proc_address), debug);
    }

    void destroy() {
        egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT) egl_.destroy_context(display_, context_);
        egl_.terminate(display_);
    }

    Egl egl_;
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> create_egl_context(bool debug) {
    const Egl egl;
    std::string tried;
    EGLDisplay software_display = EGL_NO_DISPLAY;
    for (EGLDisplay display : candidate_displays(egl)) {
        try {
            auto context = std::make_unique<EglContext>(egl, display, debug);
            if (!is_software_driver()) return context;
            software_display = display;
        } catch (const Error& error) {
            // Several displays of one driver say the same.
            if (tried.find(error.what()) == std::string::npos) tried += fmt::format("; {}", error.what());
        }
    }
    // Contexts are made one at a time: two of one driver at once would share the function pointers.
    if (software_display != EGL_NO_DISPLAY) return std::make_unique<EglContext>(egl, software_display, debug);
    throw Error(Fault::context, "EGL", "no display without a window offers OpenGL 4.5 core" + tried,
                "choose ContextOptions::kind osmesa (software)");
}

}  // namespace cairn::gl

#include "gl/context.h"

#include <array>
#include <cstddef>
#include <filesystem>

#include <fmt/format.h>
#include <glad/gl.h>
#include <sys/mman.h>

#include "base/error.h"
#include "gl/context_backends.h"

namespace cairn::gl {
namespace {

const char* text_of(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text != nullptr ? text : "unknown";
}

/// Opening EGL only to find a software driver costs memory and time, so look for a device first.
bool has_graphics_device() {
    std::error_code ignored;
    for (const char* path : {"/dev/nvidia0", "/dev/nvidiactl", "/dev/dxg", "/dev/mali0", "/dev/kgsl-3d0"}) {
        if (std::filesystem::exists(path, ignored)) return true;
    }
    for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", ignored)) {
        if (entry.path().filename().string().starts_with("renderD")) return true;
    }
    return false;
}

std::unique_ptr<Context> create_automatic(bool debug) {
    std::string tried;
    auto attempt = [&](auto create) -> std::unique_ptr<Context> {
        try {
            return create(debug);
        } catch (const Error& error) {
            tried += fmt::format("{}{}", tried.empty() ? "" : "; ", error.what());
            return nullptr;
        }
    };
    if (has_graphics_device()) {
        std::unique_ptr<Context> context = attempt(create_egl_context);
        if (context != nullptr && !is_software_driver()) return context;
    }
    if (auto context = attempt(create_osmesa_context)) return context;
    if (auto context = attempt(create_egl_context)) return context;
    throw Error(Fault::context, "OpenGL 4.5", "no driver offers it (" + tried + ")",
                "install Mesa's software driver (Debian: libosmesa6, or libegl1 and libgl1-mesa-dri)");
}

std::unique_ptr<Context> create_of_kind(const ContextOptions& options) {
    switch (options.kind) {
        case ContextKind::osmesa:
            return create_osmesa_context(options.debug);
        case ContextKind::egl:
            return create_egl_context(options.debug);
        case ContextKind::automatic:
            break;
    }
    return create_automatic(options.debug);
}

/// Whether the process may not take as much address space as a driver with its compiler does. Libraries that
/// cannot be loaded, and drivers that do not start, do not say that this is why.
bool memory_is_short() {
    constexpr std::size_t of_a_driver = std::size_t(256) << 20;
    void* const probe =
        mmap(nullptr, of_a_driver, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (probe == MAP_FAILED) return true;
    munmap(probe, of_a_driver);
    return false;
}

class AdoptedContext final : public Context {
public:
    explicit AdoptedContext(void* (*get_proc_address)(const char*)) {
        load_functions(get_proc_address, false);
    }
    void make_current() override {}
    [[nodiscard]] std::string_view backend() const override { return "adopted"; }
};

}  // namespace

void Context::load_functions(void* (*get_proc_address)(const char*), bool debug) {
    const int version = gladLoadGL(reinterpret_cast<GLADloadfunc>(get_proc_address));
    if (version == 0)
        throw Error(Fault::context, std::string(backend()), "the driver gives no OpenGL functions",
                    "update the driver, or choose another ContextOptions::kind");
    if (version < GLAD_MAKE_VERSION(4, 5)) {
        throw Error(Fault::context, fmt::format("driver \"{}\"", text_of(GL_RENDERER)),
                    fmt::format("OpenGL 4.5 core is needed, it offers {}", text_of(GL_VERSION)),
                    "update the driver, or choose another ContextOptions::kind");
    }
    if (debug) debug_log_->attach();
}

std::unique_ptr<Context> create_context(const ContextOptions& options) {
    try {
        return create_of_kind(options);
    } catch (const Error& error) {
        if (error.fault() != Fault::context || !memory_is_short()) throw;
        throw Error(Fault::memory, "OpenGL 4.5",
                    fmt::format("there is too little memory for a driver ({})", error.what()),
                    "let the process take more memory");
    }
}

std::unique_ptr<Context> adopt_context(void* (*get_proc_address)(const char*)) {
    return std::make_unique<AdoptedContext>(get_proc_address);
}

std::string driver_name() {
    return fmt::format("{}, OpenGL {}", text_of(GL_RENDERER), text_of(GL_VERSION));
}

bool is_software_driver() {
    const std::string_view renderer = text_of(GL_RENDERER);
    constexpr std::array software = {"llvmpipe", "softpipe", "swrast", "SWR", "SwiftShader"};
    for (const char* name : software) {
        if (renderer.find(name) != std::string_view::npos) return true;
    }
    return false;
}

}  // namespace cairn::gl

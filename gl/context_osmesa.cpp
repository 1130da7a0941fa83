#include <array>

#include <GL/osmesa.h>

#include "base/error.h"
#include "gl/context_backends.h"
#include "gl/dynamic_library.h"

namespace cairn::gl {
namespace {

class OsmesaContext final : public Context {
public:
    explicit OsmesaContext(bool debug)
        : library_({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}, "libosmesa6") {
        const std::array<int, 11> attributes = {OSMESA_FORMAT,
                                                OSMESA_RGBA,
                                                OSMESA_DEPTH_BITS,
                                                0,
                                                OSMESA_PROFILE,
                                                OSMESA_CORE_PROFILE,
                                                OSMESA_CONTEXT_MAJOR_VERSION,
                                                4,
                                                OSMESA_CONTEXT_MINOR_VERSION,
                                                5,
                                                0};
        const auto create =
            library_.function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
        context_ = create(attributes.data(), nullptr);
        // Without 4.5, whatever there is can at least say its name: load_functions refuses it with that.
        const std::array<int, 3> any = {OSMESA_FORMAT, OSMESA_RGBA, 0};
        if (context_ == nullptr) context_ = create(any.data(), nullptr);
        if (context_ == nullptr) {
            throw Error(Fault::context, "OSMesa", "it offers no OpenGL 4.5 core context",
                        "install Mesa 17 or later, or choose --context egl");
        }
        try {
            OsmesaContext::make_current();
            load_functions(reinterpret_cast<void* (*)(const char*)>(
                               library_.function<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress")),
                           debug);
        } catch (...) {
            destroy();
            throw;
        }
    }
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;
    OsmesaContext(OsmesaContext&&) = delete;
    OsmesaContext& operator=(OsmesaContext&&) = delete;
    ~OsmesaContext() override { destroy(); }

    void make_current() override {
        // A default framebuffer must exist, but nothing here draws to it.
        const auto make = library_.function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
        if (make(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE) {
            throw Error(Fault::context, "OSMesa", "the context cannot be made current");
        }
    }
    [[nodiscard]] std::string_view backend() const override { return "osmesa"; }

private:
    void destroy() { library_.function<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")(context_); }

    DynamicLibrary library_;
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4> pixel_{};
};

}  // namespace

std::unique_ptr<Context> create_osmesa_context(bool debug) {
    return std::make_unique<OsmesaContext>(debug);
}

}  // namespace cairn::gl

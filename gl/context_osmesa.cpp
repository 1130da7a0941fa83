#include <array>

#include "base/error.h"
#include "gl/context_backends.h"
#include "gl/dynamic_library.h"
#include "gl/osmesa.h"

namespace cairn::gl {
namespace {

class OsmesaContext final : public Context {
public:
    explicit OsmesaContext(bool debug)
        : library_({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}, "libosmesa6"),
          destroy_(library_.function<OSMesaDestroyContextFn*>("OSMesaDestroyContext")) {
        const std::array<int, 11> attributes = {osmesa_format,
                                                osmesa_rgba,
                                                osmesa_depth_bits,
                                                0,
                                                osmesa_profile,
                                                osmesa_core_profile,
                                                osmesa_context_major_version,
                                                4,
                                                osmesa_context_minor_version,
                                                5,
                                                0};
        const auto create = library_.function<OSMesaCreateContextAttribsFn*>("OSMesaCreateContextAttribs");
        context_ = create(attributes.data(), nullptr);
        // Without 4.5, whatever there is can at least say its name: load_functions refuses it with that.
        const std::array<int, 3> any = {osmesa_format, osmesa_rgba, 0};
        if (context_ == nullptr) context_ = create(any.data(), nullptr);
        if (context_ == nullptr) {
            throw Error(Fault::context, "OSMesa", "it offers no OpenGL 4.5 core context",
                        "install Mesa 17 or later, or choose ContextOptions::kind egl");
        }
        try {
            OsmesaContext::make_current();
            load_functions(reinterpret_cast<void* (*)(const char*)>(
                               library_.function<OSMesaGetProcAddressFn*>("OSMesaGetProcAddress")),
                           debug);
        } catch (...) {
            destroy_(context_);
            throw;
        }
    }
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;
    OsmesaContext(OsmesaContext&&) = delete;
    OsmesaContext& operator=(OsmesaContext&&) = delete;
    ~OsmesaContext() override { destroy_(context_); }

    void make_current() override {
        // A default framebuffer must exist, but nothing here draws to it.
        const auto make = library_.function<OSMesaMakeCurrentFn*>("OSMesaMakeCurrent");
        if (make(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE) {
            throw Error(Fault::context, "OSMesa", "the context cannot be made current",
                        "choose ContextOptions::kind egl");
        }
    }
    [[nodiscard]] std::string_view backend() const override { return "osmesa"; }

private:
    DynamicLibrary library_;
    OSMesaDestroyContextFn* destroy_;
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4> pixel_{};
};

}  // namespace

std::unique_ptr<Context> create_osmesa_context(bool debug) {
    return std::make_unique<OsmesaContext>(debug);
}

}  // namespace cairn::gl

#pragma once

#include <memory>
#include <string>

#include "app/options/options.h"
#include "gl/context.h"

namespace cairn::app {

/// KHR_debug is to listen: in debug builds, and where the environment holds CAIRN_GL_DEBUG.
[[nodiscard]] bool wants_debugging();

/// @throws Error (Fault::context) when KHR_debug heard of an error or of undefined behaviour: a bug of ours.
void check_debug_log(gl::Context& context);

/// The OpenGL context of a verb. In debug builds, and where the environment holds CAIRN_GL_DEBUG, KHR_debug
/// listens.
class Driver {
public:
    /// @throws Error (Fault::context)
    explicit Driver(const DriverOptions& options);

    [[nodiscard]] std::string name() const;     ///< "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 ..."
    [[nodiscard]] std::string backend() const;  ///< "osmesa" or "egl"
    /// @throws Error (Fault::context) when KHR_debug heard of an error or of undefined behaviour: a bug of
    /// ours.
    void check() const;

private:
    std::unique_ptr<gl::Context> context_;
};

}  // namespace cairn::app

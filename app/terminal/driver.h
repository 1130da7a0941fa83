#pragma once

#include <memory>
#include <string>

#include "app/options/options.h"
#include "gl/context.h"

namespace cairn::app {

/// Whether KHR_debug is to be on: in debug builds, and if the environment holds CAIRN_GL_DEBUG.
[[nodiscard]] bool wants_debugging();

/// @throws Error (Fault::context) if KHR_debug has reported an error or undefined behaviour: a bug of Cairn.
void check_debug_log(gl::Context& context);

/// The OpenGL context of a verb, with KHR_debug if wants_debugging().
class Driver {
public:
    /// @throws Error (Fault::context) if there is no usable OpenGL 4.5.
    explicit Driver(const DriverOptions& options);

    /// For instance "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 ...".
    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::string backend() const;  ///< "osmesa" or "egl"
    /// @throws Error as check_debug_log() does.
    void check() const;

private:
    std::unique_ptr<gl::Context> context_;
};

}  // namespace cairn::app

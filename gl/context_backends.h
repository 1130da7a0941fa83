#pragma once

#include <memory>

#include "gl/context.h"

namespace cairn::gl {

/// Both functions throw Error (Fault::context) if their library is absent or offers no OpenGL 4.5.
[[nodiscard]] std::unique_ptr<Context> create_osmesa_context(bool debug);
[[nodiscard]] std::unique_ptr<Context> create_egl_context(bool debug);

}  // namespace cairn::gl

#pragma once

#include <cstdint>

#include "gl/buffer.h"
#include "gl/handle.h"

namespace cairn::gl {

/// A texture through which shaders read a buffer.
/// @param format  a GLenum, GL_R32UI for example. A shader sees at most Limits::texture_buffer_texels of it.
[[nodiscard]] TextureHandle buffer_texture(std::uint32_t format, const Buffer& buffer);

}  // namespace cairn::gl

#pragma once

#include <glad/gl.h>

/// The part of Mesa's <GL/osmesa.h> that is used here. Declared by hand because the library is opened at run
/// time, and Mesa 25.1 and later ship neither it nor its header: Cairn must build there, and use EGL.
extern "C" {

using OSMesaContext = struct osmesa_context*;
using OSMESAproc = void (*)();

using OSMesaCreateContextAttribsFn = OSMesaContext(const int* attributes, OSMesaContext share);
using OSMesaDestroyContextFn = void(OSMesaContext context);
using OSMesaMakeCurrentFn = GLboolean(OSMesaContext context, void* pixels, GLenum type, GLsizei width,
                                      GLsizei height);
using OSMesaGetProcAddressFn = OSMESAproc(const char* name);
}

namespace cairn::gl {

constexpr int osmesa_format = 0x22;
constexpr int osmesa_rgba = GL_RGBA;
constexpr int osmesa_depth_bits = 0x30;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_context_major_version = 0x36;
constexpr int osmesa_context_minor_version = 0x37;

}  // namespace cairn::gl

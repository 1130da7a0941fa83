// A target that links a library of the build tree sees its public headers alone: not the others by their
// names from the project's root, and not OpenGL's loader.
#include <cairn/renderer/renderer.h>

#if __has_include(<base/error.h>) || __has_include(<renderer/renderer.h>) || __has_include(<glad/gl.h>)
#error "headers that are not public are on the include path of a library user"
#endif
#if __has_include(<cairn/gl/program.h>)
#error "a header that is not public was written beside those that are"
#endif

// The consumer's loader, which loads nothing: if the library called through it, it would crash.
#include <glad/gl.h>

int GLAD_GL_VERSION_4_5 = 0;
void (*glad_glUseProgram)(unsigned) = nullptr;
void (*glad_glDispatchCompute)(unsigned, unsigned, unsigned) = nullptr;

int gladLoadGL(void* (*)(const char*)) {
    return 0;
}

#pragma once

// Another project's OpenGL loader: its functions have the names that glad gives to all.
extern int GLAD_GL_VERSION_4_5;
extern void (*glad_glUseProgram)(unsigned);
extern void (*glad_glDispatchCompute)(unsigned, unsigned, unsigned);
int gladLoadGL(void* (*load)(const char*));

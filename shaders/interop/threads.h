// Threads per workgroup of the compute programs that gl::dispatch_threads() runs and that take the number of
// their thread from shaders/common/thread.glsl. 64 fills a wave of every GPU in use (32 threads on NVIDIA and
// Intel, 32 or 64 on AMD).
#ifndef CAIRN_INTEROP_THREADS_H
#define CAIRN_INTEROP_THREADS_H

#define THREADS_PER_GROUP 64

#endif

// Threads per workgroup of the compute programs that gl::dispatch_threads() runs, where a room has no reason for another
// number. 64 fills a wave of every GPU in use (32 threads on NVIDIA and Intel, 32 or 64 on AMD).
#ifndef CAIRN_INTEROP_THREADS_H
#define CAIRN_INTEROP_THREADS_H

#define THREADS_PER_GROUP 64

#endif

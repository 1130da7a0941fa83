// The number of a thread among those of gl::dispatch_threads(), which folds them over x and y if one axis is
// too short.
#include "interop/threads.h"

layout(local_size_x = THREADS_PER_GROUP) in;

uint thread_index() {
    return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * uint(THREADS_PER_GROUP);
}

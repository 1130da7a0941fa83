// The number of a thread among those of gl::dispatch_threads(), which folds them over x and y if one axis is
// too short.
// Needs the define GROUP_SIZE: threads per workgroup.
layout(local_size_x = GROUP_SIZE) in;

uint thread_index() {
    return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * uint(GROUP_SIZE);
}

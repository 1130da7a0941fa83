// The same as project.geom.glsl without a geometry shader, where the driver lets a vertex shader choose the
// layer and read storage buffers: an instance is a direction, and each vertex fetches the whole primitive.
#extension GL_ARB_shader_viewport_layer_array : require
#include "voxelize/projection.glsl"
#include "voxelize/raster_lists.glsl"
#include "voxelize/surface.glsl"

uniform uint kind;  // of the list

void main() {
    const int drawn = COVER != 0 ? 3 : CORNERS;
    const uint primitive = uint(gl_VertexID / drawn);
    ivec3 corners[CORNERS];
    for (int i = 0; i < CORNERS; ++i) {
        corners[i] = surface_position(raster_lists[first_vertex(kind) + primitive * CORNERS + uint(i)]);
    }
#if AXES == 3
    const int axis = gl_InstanceID;
    gl_Layer = axis;
#elif AXES == 1
    const int axis = 2;
    gl_Layer = 0;
#else
    const int axis = dominant_axis(corners);
    gl_Layer = axis;
#endif
    put(project(corners, axis), gl_VertexID % drawn, primitive);
}

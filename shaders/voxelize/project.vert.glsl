// Sends a primitive to the layer of each direction that looks at it, as project.geom.glsl does, but without a
// geometry shader. The driver must allow vertex shaders to choose the layer and to read storage buffers. An
// instance is a direction, and each vertex fetches the whole primitive.
#extension GL_ARB_shader_viewport_layer_array : require
#include "voxelize/projection.glsl"
#include "voxelize/raster_lists.glsl"
#include "voxelize/surface.glsl"

uniform uint kind;  // RASTER_*: the list that is drawn

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

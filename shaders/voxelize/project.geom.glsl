// Sends a primitive to the layer of each direction that looks at it (Forest et al. 2009, section 2.2), so
// that the geometry is drawn once. OpenGL 4.5 suffices for this shader; project.vert.glsl does the same
// without a geometry shader.
#include "voxelize/projection.glsl"

#if AXES == 3
#define INVOCATIONS 3
#else
#define INVOCATIONS 1
#endif

#if CORNERS == 3
layout(triangles, invocations = INVOCATIONS) in;
#elif CORNERS == 2
layout(lines, invocations = INVOCATIONS) in;
#else
layout(points, invocations = INVOCATIONS) in;
#endif

#if CORNERS == 3 || COVER
#define DRAWN 3
layout(triangle_strip, max_vertices = 3) out;
#elif CORNERS == 2
#define DRAWN 2
layout(line_strip, max_vertices = 2) out;
#else
#define DRAWN 1
layout(points, max_vertices = 1) out;
#endif

in ivec3 corner[];

void main() {
    ivec3 corners[CORNERS];
    for (int i = 0; i < CORNERS; ++i) corners[i] = corner[i];
#if AXES == 3
    const int axis = gl_InvocationID;
    const int layer = axis;
#elif AXES == 1
    const int axis = 2;
    const int layer = 0;
#else
    const int axis = dominant_axis(corners);
    const int layer = axis;
#endif
    const Projection p = project(corners, axis);
    if (!p.visible) return;
    for (int i = 0; i < DRAWN; ++i) {
        put(p, i, uint(gl_PrimitiveIDIn));
        gl_Layer = layer;
        EmitVertex();
    }
    EndPrimitive();
}

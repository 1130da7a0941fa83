// Passes a vertex on to project.geom.glsl.
#include "interop/surface.h"

layout(location = ATTRIBUTE_POSITION) in ivec3 position;  // lattice units
out ivec3 corner;

void main() { corner = position; }

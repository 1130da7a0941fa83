// How a mesh stands to the rays of a picture.
#include "interop/mesh.h"

layout(std140, binding = UBO_MESH_VIEW) uniform MeshViewBlock { MeshView mesh_view; };

// From the moved eye, in the marcher's units. In double, because the mesh, the eye and the world's origin may
// lie far from one another.
dvec3 from_eye(ivec3 lattice) { return dvec3(lattice) * mesh_view.lattice_unit + mesh_view.origin; }

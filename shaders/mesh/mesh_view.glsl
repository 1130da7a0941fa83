// The place of a mesh relative to the rays of a picture.
#include "interop/mesh.h"

layout(std140, binding = UBO_MESH_VIEW) uniform MeshViewBlock { MeshView mesh_view; };

// A point of the lattice relative to MarchView.eye, in units of the MarchView. It is a double, because the
// mesh, the eye and the world's origin may lie far from one another.
dvec3 from_eye(ivec3 lattice) { return dvec3(lattice) * mesh_view.lattice_unit + mesh_view.origin; }

// One vertex is a corner of one of the twelve triangles of a box. The depth is 1 / distance along the view,
// so that all bits of a float count. Row 0 of the picture is row 0 of the target.
uniform vec3 box_low;  // low corner relative to the eye, in voxels of the finest level
uniform vec3 box_high;
uniform vec3 forward;
// Scalar products of `across` and `down` with a point at distance 1 along the view: its place in the picture,
// [-1, 1].
uniform vec3 across;
uniform vec3 down;

// Corners of two triangles per face: x, y, z in bits 0 to 2.
const int corners[36] = int[](0, 2, 4, 4, 2, 6, 1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5,
                              2, 3, 6, 6, 3, 7, 0, 1, 2, 2, 1, 3, 4, 6, 5, 5, 6, 7);

void main() {
    const int corner = corners[gl_VertexID];
    const bvec3 is_high = notEqual(ivec3(corner) & ivec3(1, 2, 4), ivec3(0));
    const vec3 p = mix(box_low, box_high, is_high);
    gl_Position = vec4(dot(p, across), dot(p, down), 1.0, dot(p, forward));
}

// A descent begins at the lowest node that holds both the ray's voxel and the voxel of the descent before:
// the DDA with a mini-stack of Crassin 2007, section 3.4.3. It is a short stack (Horn et al. 2007) of the
// four lowest nodes, in registers, because drivers keep indexed arrays in memory. A ray that climbs further
// begins at the root.
uint trail_0;  // entry of the lowest node whose children the descent looked at
uint trail_1;  // its parent, and so on
uint trail_2;
uint trail_3;
int trail_count;
int trail_shift;  // log2 of the side of the lowest node's tile
ivec3 trail_cell;

void forget_trail() {
    trail_0 = trail_1 = trail_2 = trail_3 = 0u;
    trail_count = 0;
    trail_shift = ROOT_SHIFT;
    trail_cell = ivec3(0);
}

// Takes the node where the descent begins off the stack. @return log2 of the side of its tile.
int resume(Ray ray, out uint entry, out uvec4 node) {
    int up = 0;
    up += same_cell(ray.cell, trail_cell, trail_shift) ? 0 : 1;
    up += same_cell(ray.cell, trail_cell, trail_shift + N_SHIFT) ? 0 : 1;
    up += same_cell(ray.cell, trail_cell, trail_shift + 2 * N_SHIFT) ? 0 : 1;
    up += same_cell(ray.cell, trail_cell, trail_shift + 3 * N_SHIFT) ? 0 : 1;
#if PROGRESSIVE
    if (stand_in) up = 4;  // an ancestor that stands in may be anywhere on the way down
#endif
    const bool restarts = up >= trail_count;
    const bool two = up >= 2;
    const bool one = (up & 1) != 0;
    entry = two ? (one ? trail_3 : trail_2) : (one ? trail_1 : trail_0);
    entry = restarts ? 0u : entry;
    const int shift = restarts ? ROOT_SHIFT : trail_shift + up * N_SHIFT;
    trail_count = restarts ? 0 : trail_count - up - 1;
    // `up` + 1 nodes are taken off.
    const uint next = one ? trail_2 : trail_1;
    const uint second = one ? trail_3 : trail_2;
    trail_0 = two ? (one ? 0u : trail_3) : next;
    trail_1 = two ? 0u : second;
    trail_2 = up == 0 ? trail_3 : 0u;
    node = texelFetch(nodes, int(entry));
    return shift;
}

// Pushes a node whose children the descent looks at.
void leave_trail(Ray ray, uint entry, uvec4 node, int tile_shift) {
    trail_3 = trail_2;
    trail_2 = trail_1;
    trail_1 = trail_0;
    trail_0 = entry;
    trail_count = min(trail_count + 1, 4);
    trail_shift = tile_shift;
    trail_cell = ray.cell;
}

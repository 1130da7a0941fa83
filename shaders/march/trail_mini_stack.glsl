// A descent begins at the lowest node that holds both the ray's voxel and that of the descent before: the DDA
// with a mini-stack of Crassin 2007, section 3.4.3. The stack is a short one (Horn et al. 2007) of the four
// lowest nodes, in registers, because arrays with an index live in memory; a ray that climbs further begins
// at the root.
uint trail_0;  // entry of the lowest node whose children the descent looked at
uint trail_1;  // its parent, and so on
uint trail_2;
uint trail_3;
int trail_count;
int trail_shift;  // of the lowest one's tile
ivec3 trail_voxel;

void forget_trail() {
    trail_0 = trail_1 = trail_2 = trail_3 = 0u;
    trail_count = 0;
    trail_shift = ROOT_SHIFT;
    trail_voxel = ivec3(0);
}

// Takes the node where the descent begins off the stack. @return the shift of its tile.
int resume(Ray ray, out uint entry, out uvec4 node) {
    int up = 0;
    up += same_cell(ray.voxel, trail_voxel, trail_shift) ? 0 : 1;
    up += same_cell(ray.voxel, trail_voxel, trail_shift + N_SHIFT) ? 0 : 1;
    up += same_cell(ray.voxel, trail_voxel, trail_shift + 2 * N_SHIFT) ? 0 : 1;
    up += same_cell(ray.voxel, trail_voxel, trail_shift + 3 * N_SHIFT) ? 0 : 1;
#if PROGRESSIVE
    if (stand_in) up = 4;  // what stands in is looked for along the whole way down
#endif
    const bool restarts = up >= trail_count;
    const bool two = up >= 2;
    const bool one = (up & 1) != 0;
    entry = two ? (one ? trail_3 : trail_2) : (one ? trail_1 : trail_0);
    entry = restarts ? 0u : entry;
    const int shift = restarts ? ROOT_SHIFT : trail_shift + up * N_SHIFT;
    trail_count = restarts ? 0 : trail_count - up - 1;
    // One more than `up` are taken off.
    const uint next = one ? trail_2 : trail_1;
    const uint second = one ? trail_3 : trail_2;
    trail_0 = two ? (one ? 0u : trail_3) : next;
    trail_1 = two ? 0u : second;
    trail_2 = up == 0 ? trail_3 : 0u;
    node = texelFetch(nodes, int(entry));
    return shift;
}

// The descent looks at the children of this node.
void leave_trail(Ray ray, uint entry, uvec4 node, int tile_shift) {
    trail_3 = trail_2;
    trail_2 = trail_1;
    trail_1 = trail_0;
    trail_0 = entry;
    trail_count = min(trail_count + 1, 4);
    trail_shift = tile_shift;
    trail_voxel = ray.voxel;
}

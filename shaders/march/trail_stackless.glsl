// A descent begins at the node whose children the ray crosses, as long as it is among them: the recursive DDA
// without a stack of Crassin 2007, section 3.4.3, which computes everything anew from the ray's place at each
// step down or up. There a node points to its parent; here a ray that leaves its node climbs by a descent
// from the root, for a node entry has no room for the parent.
uint trail_entry;
ivec3 trail_voxel;
int trail_shift;  // of the node's tile; -1: none

void forget_trail() {
    trail_entry = 0u;
    trail_voxel = ivec3(0);
    trail_shift = -1;
}

// @return the shift of the tile where the descent begins, with its entry and node.
int resume(Ray ray, out uint entry, out uvec4 node) {
    bool stays = trail_shift >= 0 && same_cell(ray.voxel, trail_voxel, trail_shift);
#if PROGRESSIVE
    stays = stays && !stand_in;  // what stands in is looked for along the whole way down
#endif
    entry = stays ? trail_entry : 0u;
    node = texelFetch(nodes, int(entry));
    return stays ? trail_shift : ROOT_SHIFT;
}

// The descent looks at the children of this node.
void leave_trail(Ray ray, uint entry, uvec4 node, int tile_shift) {
    trail_entry = entry;
    trail_voxel = ray.voxel;
    trail_shift = tile_shift;
}

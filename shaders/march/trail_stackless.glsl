// A descent begins at the node whose children the ray crosses, as long as the ray stays among them: the
// recursive DDA without a stack of Crassin 2007, section 3.4.3, which computes everything anew from the ray's
// place at each step down or up. In Crassin 2007 a node points to its parent; here a ray that leaves its node
// starts again at the root, because a node entry has no room for the parent.
uint trail_entry;
ivec3 trail_cell;
int trail_shift;  // log2 of the side of the node's tile; -1: no node

void forget_trail() {
    trail_entry = 0u;
    trail_cell = ivec3(0);
    trail_shift = -1;
}

// @return log2 of the side of the tile where the descent begins, with its entry and node.
int resume(Ray ray, out uint entry, out uvec4 node) {
    bool stays = trail_shift >= 0 && same_cell(ray.cell, trail_cell, trail_shift);
#if PROGRESSIVE
    stays = stays && !stand_in;  // an ancestor that stands in may be anywhere on the way down
#endif
    entry = stays ? trail_entry : 0u;
    node = texelFetch(nodes, int(entry));
    return stays ? trail_shift : ROOT_SHIFT;
}

// Takes a node whose children the descent looks at.
void leave_trail(Ray ray, uint entry, uvec4 node, int tile_shift) {
    trail_entry = entry;
    trail_cell = ray.cell;
    trail_shift = tile_shift;
}

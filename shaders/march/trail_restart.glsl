// Every descent begins at the root (kd-restart: Foley and Sugerman 2005; Crassin et al. 2008, section 5.1).
void forget_trail() {}

// @return log2 of the side of the tile where the descent begins, with its entry and node.
int resume(Ray ray, out uint entry, out uvec4 node) {
    entry = 0u;
    node = texelFetch(nodes, 0);
    return ROOT_SHIFT;
}

// Takes a node whose children the descent looks at.
void leave_trail(Ray ray, uint entry, uvec4 node, int tile_shift) {}

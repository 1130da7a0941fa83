// Down the tree, from its root to the tile that a ray asks for.
// The brick that a ray is in.
struct Place {
    int slot;         // -1: none
    int tile_shift;   // log2 of the tile's side
    int mip;          // of the brick: the one that is shown, or the finer of the two that are blended
#if PROGRESSIVE
    int brick_shift;  // log2 of the side of the tile whose brick it is: that one, or an ancestor that stands in
#endif
    uvec2 summary;    // which blocks of 4^3 voxels are not empty (all of them when there are at most 64)
};

// Log2 of the side of the brick's own voxels.
int own_shift_of(Place place) {
#if PROGRESSIVE
    return place.brick_shift - M_SHIFT;
#else
    return place.tile_shift - M_SHIFT;
#endif
}

// Log2 of the side of the voxels that are shown (of the finer ones).
int voxel_shift_of(Place place) { return own_shift_of(place) + place.mip; }

// The finer of the mips that a cone of this width sees of a brick with voxels of this size.
int mip_for(int own_shift, float width) {
#if BLENDED
    return blended_mip(own_shift, width);
#else
    return 0;
#endif
}

#if BLENDED
// Has the cone grown past what the place was chosen for? The root's coarsest mip goes on for ever.
bool needs_coarser(Place place, float width) {
#if PROGRESSIVE
    if (place.brick_shift != place.tile_shift) return false;  // it stands in
#endif
    if (place.tile_shift == ROOT_SHIFT && place.mip == BRICK_MIPS - 1) return false;
    return blended_size(own_shift_of(place), width) >= float(cell_side(voxel_shift_of(place) + 1));
}
#endif

#define DESCENT_FOUND 0    // place holds a brick
#define DESCENT_EMPTY 1    // nothing here: `empty_shift` is the side of the cell to step over
#define DESCENT_MISSING 2  // the tile was asked for

void use_brick(inout Place place, int slot) {
    place.slot = slot;
    place.summary = texelFetch(brick_masks, slot * MASK_WORDS_A_SLOT).xy;
    touch(slot);
}

#if PROGRESSIVE
// The nearest node above the ray's voxel that has a brick.
struct Ancestor {
    int slot;  // -1: none
    int tile_shift;
};

// Shows the cell around the ray's voxel by the ancestor's brick, or as empty.
int stand_in_for_cell(Ancestor ancestor, int shift, inout Place place, out int empty_shift) {
    atomicAdd(counters.stood_in, 1u);
    empty_shift = shift;
    if (ancestor.slot < 0) return DESCENT_EMPTY;
    place.tile_shift = shift;
    place.brick_shift = ancestor.tile_shift;
    use_brick(place, ancestor.slot);
    return DESCENT_FOUND;
}
#endif

// Finds the tile that the ray's cone asks for at its voxel: kd-restart.
int descend(Ray ray, out Place place, out int empty_shift) {
    const float width = width_at(ray);
    uint entry = 0u;
    uvec4 node = texelFetch(nodes, 0);
    place.slot = -1;
    place.tile_shift = ROOT_SHIFT;
    place.mip = 0;
#if PROGRESSIVE
    place.brick_shift = ROOT_SHIFT;
#endif
    place.summary = uvec2(0u);
    empty_shift = ROOT_SHIFT;
    if (MAX_LEVEL > 0 && has_no_child(node)) return DESCENT_EMPTY;  // nothing in the whole scene
#if PROGRESSIVE
    Ancestor ancestor = Ancestor(-1, ROOT_SHIFT);
#endif
    for (int level = 0; level < MAX_LEVEL; ++level) {
        if (float(cell_side(place.tile_shift - M_SHIFT)) <= width) break;
        const ivec3 c = place_in(ray.voxel, place.tile_shift - N_SHIFT, N_SHIFT);
        const int empty = empty_child_shift(node, c);
        if (empty >= 0) {
            empty_shift = place.tile_shift - N_SHIFT + empty;
            return DESCENT_EMPTY;
        }
#if PROGRESSIVE
        if (brick_slot(node) >= 0) ancestor = Ancestor(brick_slot(node), place.tile_shift);
        else ask(2u * entry_count + entry);
#endif
        if (!has_children(node)) {
            query(entry, QUERY_CHILDREN);
#if PROGRESSIVE
            if (stand_in) return stand_in_for_cell(ancestor, place.tile_shift - N_SHIFT, place, empty_shift);
#endif
            return DESCENT_MISSING;
        }
        entry = child_entry(node, c);
        node = texelFetch(nodes, int(entry));
        place.tile_shift -= N_SHIFT;
    }
#if PROGRESSIVE
    place.brick_shift = place.tile_shift;
#endif
    if (brick_slot(node) < 0) {
        query(entry, QUERY_BRICK);
#if PROGRESSIVE
        if (stand_in) return stand_in_for_cell(ancestor, place.tile_shift, place, empty_shift);
#endif
        return DESCENT_MISSING;
    }
    place.mip = mip_for(place.tile_shift - M_SHIFT, width);
    use_brick(place, brick_slot(node));
    return DESCENT_FOUND;
}

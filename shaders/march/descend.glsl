// The way down the tree to the tile that a ray asks for.
#include "interop/march.h"
#include "interop/tile_query.h"
#include "interop/windows.h"
#include "march/brick_words.glsl"

// The brick that a ray is in.
struct Place {
    int slot;         // -1: none
    int brick;        // where the slot's masks are: brick_start()
    int tile_shift;   // log2 of the tile's side
    // Mip of the brick that is shown, or the finer of the two that are blended.
    int mip;
#if PROGRESSIVE
    // log2 of the side of the tile that the brick belongs to: this tile, or an ancestor that stands in.
    int brick_shift;
#endif
#if HAS_CONSTANT
    uint entry;       // entry of the constant node, after DESCENT_CONSTANT
#endif
    // Bits of the brick's first 64 blocks of voxels: whether the block is not empty.
    uvec2 summary;
};

// Log2 of the side of the voxels of the brick's mip 0.
int brick_voxel_shift_of(Place place) {
#if PROGRESSIVE
    return place.brick_shift - M_SHIFT;
#else
    return place.tile_shift - M_SHIFT;
#endif
}

// Log2 of the side of the voxels that are shown; of the finer ones, if two mips are blended.
int voxel_shift_of(Place place) { return brick_voxel_shift_of(place) + place.mip; }

#if BLENDED
// Has the cone grown past the width that the place was chosen for? The root's coarsest mip serves all widths.
bool needs_coarser(Ray ray, Place place) {
#if PROGRESSIVE
    if (place.brick_shift != place.tile_shift) return false;  // an ancestor stands in
#endif
    const int brick_voxel_shift = brick_voxel_shift_of(place);
    if (place.mip + 1 < BRICK_MIPS) return sees_mip(ray, brick_voxel_shift, place.mip + 1);
    return place.tile_shift < ROOT_SHIFT && sees_mip(ray, brick_voxel_shift + N_SHIFT, 0);
}
#endif

#define DESCENT_FOUND 0    // place holds a brick
#define DESCENT_EMPTY 1    // the cell of side `empty_shift` around the voxel is empty, to be stepped over
#define DESCENT_MISSING 2  // the tile is missing, and was queried
#if HAS_CONSTANT
#define DESCENT_CONSTANT 3  // place holds a constant tile, whose value is not 0
#endif

void use_brick(inout Place place, int slot) {
    place.slot = slot;
    place.brick = brick_start(slot);
    place.summary = mask_word(place.brick, 0);
    touch(slot);
}

#if PROGRESSIVE
// The nearest node above the ray's voxel that has a brick.
struct Ancestor {
    int slot;  // -1: none
    int tile_shift;
#if HAS_CONSTANT
    uint entry;
    bool is_constant;  // the ancestor has one value and no brick
#endif
};

Ancestor ancestor_of(uvec4 node, uint entry, int tile_shift) {
#if HAS_CONSTANT
    return Ancestor(brick_slot(node), tile_shift, entry, is_constant(node) && !is_empty(node));
#else
    return Ancestor(brick_slot(node), tile_shift);
#endif
}

// Shows the cell around the ray's voxel by the ancestor's brick, or as empty.
int stand_in_for_cell(Ancestor ancestor, int shift, inout Place place, out int empty_shift) {
    atomicAdd(counters.stood_in, 1u);
    empty_shift = shift;
#if HAS_CONSTANT
    if (ancestor.is_constant) {
        place.tile_shift = shift;
        place.brick_shift = ancestor.tile_shift;
        place.entry = ancestor.entry;
        return DESCENT_CONSTANT;
    }
#endif
    if (ancestor.slot < 0) return DESCENT_EMPTY;
    place.tile_shift = shift;
    place.brick_shift = ancestor.tile_shift;
    use_brick(place, ancestor.slot);
    return DESCENT_FOUND;
}
#endif

// Does the ray see this tile, around its voxel, by the tile's brick and not by those of its children? The
// distance of the whole tile decides, or of the mip's cell around the voxel, so that the answer does not
// depend on where the ray started and which way it came.
bool shows(Ray ray, int tile_shift) {
#if BLENDED
    return sees_mip(ray, tile_shift - M_SHIFT, 0);
#else
    const float voxel_side = cell_length(tile_shift - M_SHIFT);
#if RAYS_WIDEN
    const vec3 low = corner_of(cell_low(ray.cell, tile_shift)) - ray.origin;
    const vec3 away = max(max(low, -(low + cell_length(tile_shift))), vec3(0.0));
    return voxel_side <= ray.cone_base + ray.cone_slope * length(away);
#else
    return voxel_side <= ray.cone_base;
#endif
#endif
}

// The node where a descent begins, and the trail that it leaves for the next one. With windows, descents
// begin at the window's tile.
#if WINDOWS || TRAVERSAL == TRAVERSAL_RESTART
#include "march/trail_restart.glsl"
#elif TRAVERSAL == TRAVERSAL_STACKLESS
#include "march/trail_stackless.glsl"
#else
#include "march/trail_mini_stack.glsl"
#endif

// Tree level of the tile of this size around the ray.
int level_of_tile(Ray ray, int tile_shift) {
#if WINDOWS
    return windows.of[ray.window].level + (ROOT_SHIFT - tile_shift) / N_SHIFT;
#else
    return (ROOT_SHIFT - tile_shift) / N_SHIFT;
#endif
}

Place no_place() {
    Place place;
    place.slot = -1;
    place.brick = 0;
    place.tile_shift = ROOT_SHIFT;
    place.mip = 0;
#if PROGRESSIVE
    place.brick_shift = ROOT_SHIFT;
#endif
#if HAS_CONSTANT
    place.entry = 0u;
#endif
    place.summary = uvec2(0u);
    return place;
}

// Finds the tile that the ray's cone asks for at its voxel.
int descend(Ray ray, out Place place, out int empty_shift) {
    uint entry;
    uvec4 node;
    place = no_place();
    empty_shift = ROOT_SHIFT;
#if WINDOWS
    entry = window_tile(ray);
    if (entry == WINDOW_EMPTY) return DESCENT_EMPTY;
    if ((entry & WINDOW_MISSING) != 0u) {
        query(entry & ~WINDOW_MISSING, QUERY_CHILDREN, window_rank(ray));
#if PROGRESSIVE
        if (stand_in) return stand_in_for_cell(Ancestor(-1, ROOT_SHIFT), ROOT_SHIFT, place, empty_shift);
#endif
        return DESCENT_MISSING;
    }
    node = texelFetch(nodes, int(entry));
#else
    place.tile_shift = resume(ray, entry, node);
#if BLENDED
    // Around this voxel the ray may see a tile by its brick whose children it saw elsewhere: this tile, or
    // one above it.
    if (place.tile_shift < ROOT_SHIFT && shows(ray, place.tile_shift)) {
        forget_trail();
        place.tile_shift = resume(ray, entry, node);
    }
#endif
#if PROGRESSIVE
    place.brick_shift = place.tile_shift;
#endif
#endif
    // The whole scene is empty. (Further down, a tile may show something though none of its children does.)
    if (MAX_LEVEL > 0 && place.tile_shift == ROOT_SHIFT && has_no_child(node)) return DESCENT_EMPTY;
#if PROGRESSIVE
    Ancestor ancestor = ancestor_of(uvec4(0u), 0u, ROOT_SHIFT);
#endif
    for (int level = 0; level < MAX_LEVEL; ++level) {
        if (place.tile_shift == TILE_SHIFT || shows(ray, place.tile_shift)) break;
#if HAS_FINAL || TREE_N == 8
        if (is_final(node)) break;
#endif
        leave_trail(ray, entry, node, place.tile_shift);
        const ivec3 c = place_in(ray.cell, place.tile_shift - N_SHIFT, N_SHIFT);
        const int empty = empty_child_shift(node, c);
        if (empty >= 0) {
            empty_shift = place.tile_shift - N_SHIFT + empty;
            return DESCENT_EMPTY;
        }
#if PROGRESSIVE
        if (brick_slot(node) >= 0 || is_constant(node)) ancestor = ancestor_of(node, entry, place.tile_shift);
        else ask(query_word(entry, QUERY_STAND_IN));
#endif
        if (!has_children(node)) {
            query(entry, QUERY_CHILDREN, level_of_tile(ray, place.tile_shift));
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
        if (is_constant(node)) {
#if HAS_CONSTANT
            place.entry = entry;
            if (!is_empty(node)) return DESCENT_CONSTANT;
#endif
            empty_shift = place.tile_shift;
            return DESCENT_EMPTY;
        }
        query(entry, QUERY_BRICK, QUERY_RANK_BRICK);
#if PROGRESSIVE
        if (stand_in) return stand_in_for_cell(ancestor, place.tile_shift, place, empty_shift);
#endif
        return DESCENT_MISSING;
    }
#if BLENDED
    while (place.mip + 1 < BRICK_MIPS && sees_mip(ray, place.tile_shift - M_SHIFT, place.mip + 1)) ++place.mip;
#endif
    use_brick(place, brick_slot(node));
    return DESCENT_FOUND;
}

// One thread is one record of a new brick: it gives the voxel's normal its slab, and decides whether the voxel's marks
// are kept: they are not if its slab alone tells as much.
#include "interop/pool.h"
#include "produce/records.glsl"
#include "pool/slab.glsl"
#include "common/thread.glsl"

void main() {
    const uint i = thread_index();
    if (i >= record_count) return;
    const Record record = record_at(i);
    const uvec2 marks = marks_of(record);
    bool is_marked = true;
#if CELL_BASE == 2 && (GEOMETRY & GEOMETRY_SLABS) != 0
    if ((marks.x | marks.y) != 0u) {
        const uint sums = sums_of(record);
        const uint normals = with_slab(scratch[sums + PACKED_NORMALS],
                                       uvec2(scratch[sums + SLAB_REACH], scratch[sums + SLAB_REACH + 1u]));
        scratch[sums + PACKED_NORMALS] = normals;
        is_marked = !has_slab(normals) ||
                    (GEOMETRY & GEOMETRY_MARKS) != 0 && !is_slab_enough(unpack_slab(normals), marks);
    }
#endif
    if (is_marked && record.is_in_table) {
        atomicOr(marked[table_of(record.tile) + (record.number >> 5)].x, 1u << (record.number & 31u));
    }
}

// Which finer voxels a triangle may meet in a row of voxels: in 4^2 rows of finer voxels along x.
//
// The filter of voxelize/exact_triangle.glsl for 16 rows at once. A finer row in doubt is marked as far as the
// triangle may reach, because marks are an estimate: whether the voxel is occupied is decided exactly.
#include "voxelize/exact_triangle.glsl"

// Finer voxels of four rows, from a first to a last one; empty if the first lies behind the last.
struct FourSpans {
    ivec4 first, last;
};
#define NO_FINER_VOXEL 0x100000  // as a first one; its negative as a last one

// All that a row of voxels has. z counts the slices.
struct RowMarks {
    FourSpans z0, z1, z2, z3;
};

// Lower and upper bounds of x at four rows.
struct FourBounds {
    vec4 low, high;
};

FourBounds bounds_at(SideBounds s, vec4 rows) {
    FourBounds b = FourBounds(vec4(-FAR_AWAY), vec4(FAR_AWAY));
    for (int i = 0; i < 3; ++i) {
        const vec4 x = s.x[i] - s.slope[i] * (rows - s.row[i]);
        if (s.is_lower[i]) b.low = max(b.low, x);
        if (s.is_upper[i]) b.high = min(b.high, x);
    }
    return b;
}

// The spans of four rows of slice z. Closed voxel i touches [x, ...) from i = ceil(x) - 1 on.
FourSpans slice_marks(ExactTriangle fine, int z, vec4 rows, FourBounds xy, int first_x) {
    const RowSlice slice = row_slice(fine, z);
    const vec4 side = min(min(fine.side_y.x * rows + slice.side.x, fine.side_y.y * rows + slice.side.y),
                          fine.side_y.z * rows + slice.side.z);
    const vec4 plane_low = fine.has_plane ? fine.plane.x * rows + slice.plane : vec4(-FAR_AWAY);
    const vec4 plane_high = fine.has_plane ? plane_low + fine.plane_width : vec4(FAR_AWAY);
    const vec4 low =
        in_voxels(fine, max(max(xy.low, slice.xz.x) - fine.side_bounds_error, plane_low - fine.plane_error));
    const vec4 high =
        in_voxels(fine, min(min(xy.high, slice.xz.y) + fine.side_bounds_error, plane_high + fine.plane_error));
    const float end = float(fine.high.x - fine.low.x);
    const ivec4 first = ivec4(clamp(ceil(low) - 1.0, 0.0, end + 1.0)) + (fine.low.x - first_x);
    const ivec4 last = ivec4(clamp(floor(high), -1.0, end)) + (fine.low.x - first_x);
    const float last_row = float(fine.high.y - fine.low.y) * voxel_unit(fine);
    const bool in_box = z >= fine.low.z && z <= fine.high.z;
    const bvec4 beside = lessThan(min(min(rows, last_row - rows), side + SIDE_ERROR), vec4(in_box ? 0.0 : FAR_AWAY));
    return FourSpans(mix(first, ivec4(NO_FINER_VOXEL), beside), mix(last, ivec4(-NO_FINER_VOXEL), beside));
}

// The marks in the voxels of a row (y, z). Finer voxels count from `first_x` on.
RowMarks row_marks(ExactTriangle fine, ivec2 row, int first_x) {
    const vec4 rows = (float(4 * row.x - fine.low.y) + vec4(0.0, 1.0, 2.0, 3.0)) * voxel_unit(fine);
    const FourBounds xy = bounds_at(fine.xy, rows);
    return RowMarks(slice_marks(fine, 4 * row.y, rows, xy, first_x), slice_marks(fine, 4 * row.y + 1, rows, xy, first_x),
                    slice_marks(fine, 4 * row.y + 2, rows, xy, first_x),
                    slice_marks(fine, 4 * row.y + 3, rows, xy, first_x));
}

// 16 marks, bit x + 4 y, in the four finer voxels from `x` on.
uint slice_bits(FourSpans s, int x) {
    const uvec4 bits = (uvec4(0xFu) << uvec4(clamp(s.first - x, 0, 4))) & (uvec4(0xFu) >> uvec4(3 - clamp(s.last - x, -1, 3)));
    return bits.x | bits.y << 4 | bits.z << 8 | bits.w << 12;
}

// The marks of a voxel that the triangle meets: bit x + 4 (y + 4 z). `x`: its first finer voxel, as in row_marks().
uvec2 voxel_marks(RowMarks marks, int x) {
    const uvec2 found = uvec2(slice_bits(marks.z0, x) | slice_bits(marks.z1, x) << 16,
                              slice_bits(marks.z2, x) | slice_bits(marks.z3, x) << 16);
    // The filter knows nothing of a triangle that is too large for its floats.
    return (found.x | found.y) != 0u ? found : uvec2(0xFFFFFFFFu);
}

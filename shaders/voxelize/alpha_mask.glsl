// Whether the part of a masked triangle inside a closed voxel touches a closed texel square that passes the
// cutoff: exact on every driver. The definition in few lines is voxelizer/surface/exact_mask.h.
//
//     MaskedTriangle masked_triangle(uint triangle)
//     int mask_decide(MaskedTriangle m, ivec3 voxel, int shift)
//         MASK_SURFACE, MASK_EMPTY, or MASK_UNDECIDED: then exact_mask.h must decide
//     bool mask_touches(uint triangle, ivec3 voxel, int shift)
//         both functions in one step; an undecided voxel counts as surface
//
// The voxel has side 2^shift, is numbered in the root cube, and meets the triangle.
//
// A point of the triangle is given by its three weights. The sides of the voxel, of a texel, and of the
// triangle are lines that are linear and homogeneous in the weights, with whole coefficients under 2^25.6.
// The triangle's part inside the voxel is a polygon, whose corners are cross products of two such lines. They
// are whole numbers, and exact: sides of the voxel and of texels are used only if they cut the triangle, and
// then a component of the product is twice an area that lies in the bounding box, at most 9 * 2^48. The side
// of a line on which a corner lies is the sign of a sum of three products of 77 bits: the corner is split in
// two halves, the sum for each half is exact in double, and the two sums are compared. Clipping: Sutherland
// and Hodgman 1974, with closed sides: a part that only touches is left as a segment or a point.
//
// Drivers inline every call. So each step is written once, inside loops, and works on private memory.
#include "interop/surface.h"
#include "interop/voxelize.h"
#include "voxelize/surface.glsl"
#include "voxelize/surface_attributes.glsl"

const double MASK_SPLIT = 67108864.0LF;  // 2^26

struct MaskedTriangle {
    ivec3 x, y, z;        // coordinates of the vertices, on the lattice
    // Texture coordinates in units of 1 / texel_side texels, less `period`.
    ivec3 u, v;
    ivec3 alpha;          // vertex alphas, 0 to 65535
    ivec2 period;         // whole textures that were subtracted from u and v
    int texel_side;
    SurfaceMaterial material;
};

MaskedTriangle masked_triangle(uint triangle) {
    const uvec3 corners = surface_triangles[triangle].vertices;
    MaskedTriangle m;
    const ivec3 a = surface_position(corners.x), b = surface_position(corners.y), c = surface_position(corners.z);
    m.x = ivec3(a.x, b.x, c.x);
    m.y = ivec3(a.y, b.y, c.y);
    m.z = ivec3(a.z, b.z, c.z);
    m.material = surface_materials[surface_triangles[triangle].material];
    m.alpha = ivec3(attribute_alpha(corners.x), attribute_alpha(corners.y), attribute_alpha(corners.z));
    const vec2 ta = attribute_texcoord(corners.x), tb = attribute_texcoord(corners.y),
               tc = attribute_texcoord(corners.z);
    // Coordinates are multiples of 1 / TEXCOORD_UNITS. So differences are exact, and there is one rounding.
    const vec2 period = floor(min(min(ta, tb), tc));
    m.period = ivec2(period);
    const dvec2 size = dvec2(max(uvec2(m.material.width, m.material.height), 1u));
    const dvec2 span = (dvec2(max(max(ta, tb), tc)) - dvec2(period)) * size * double(TEXEL_UNITS);
    m.texel_side = TEXEL_UNITS;
    for (double most = max(span.x, span.y); most > TEXEL_COORDINATE_LIMIT; most *= 0.5LF) m.texel_side >>= 1;
    const dvec2 units = size * double(m.texel_side);
    const ivec2 pa = ivec2(roundEven((dvec2(ta) - dvec2(period)) * units));
    const ivec2 pb = ivec2(roundEven((dvec2(tb) - dvec2(period)) * units));
    const ivec2 pc = ivec2(roundEven((dvec2(tc) - dvec2(period)) * units));
    m.u = ivec3(pa.x, pb.x, pc.x);
    m.v = ivec3(pa.y, pb.y, pc.y);
    return m;
}

// Numbers of lines: sides of the triangle are 0 to 2, sides of the voxel 3 to 8, sides of a strip of texel
// rows 9 and 10.
#define MASK_VOXEL_LINES 3
#define MASK_ROW_LINES 9
#define MASK_LINE_COUNT 11
ivec3 mask_lines[MASK_LINE_COUNT];

// Room for three polygons. A polygon is a list of corners: the two lines that cross in the corner, and the
// line that follows it (4 bits each).
#define MASK_MAX_CORNERS 11  // three, and one more for each line that cuts
uint mask_corners[3 * MASK_MAX_CORNERS];

struct MaskPolygon {
    int place;  // 0, 1 or 2
    int count;  // number of corners; 0 = empty
};

dvec3 mask_corner(uint corner) {
    const dvec3 a = dvec3(mask_lines[corner & 15u]), b = dvec3(mask_lines[corner >> 4 & 15u]);
    const dvec3 p = dvec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return p.x + p.y + p.z < 0.0LF ? -p : p;
}

// The sign of a line's value at a corner.
int mask_side(ivec3 whole_line, dvec3 corner) {
    const dvec3 line = dvec3(whole_line);
    const dvec3 high = floor(corner / MASK_SPLIT);
    const dvec3 low = corner - high * MASK_SPLIT;
    const double a = (line.x * high.x + line.y * high.y + line.z * high.z) * MASK_SPLIT;
    const double b = -(line.x * low.x + line.y * low.y + line.z * low.z);
    return int(a > b) - int(a < b);
}

// The part of a polygon on the inner side of a line. It is written to a place that is neither the polygon's
// nor `kept`.
MaskPolygon mask_clip(MaskPolygon polygon, int line, int kept) {
    const ivec3 coefficients = mask_lines[line];
    if (all(greaterThanEqual(coefficients, ivec3(0)))) return polygon;
    MaskPolygon result = MaskPolygon(polygon.place == kept ? (kept + 1) % 3 : 3 - kept - polygon.place, 0);
    if (all(lessThan(coefficients, ivec3(0)))) return result;
    const uint cut = uint(line);
    uint corner = 0u;
    int side = 0;
    for (int i = 0; i <= polygon.count; ++i) {
        const uint next = mask_corners[polygon.place * MASK_MAX_CORNERS + (i < polygon.count ? i : 0)];
        const int next_side = mask_side(coefficients, mask_corner(next));
        const int end = result.place * MASK_MAX_CORNERS + result.count;
        const bool keep = i > 0 && side >= 0;
        const bool cross = i > 0 && side * next_side < 0;
        if (keep) mask_corners[end] = side == 0 && next_side < 0 ? (corner & 0xFFu) | cut << 8 : corner;
        if (cross) {
            const uint along = corner >> 8;
            mask_corners[end + int(keep)] = along | cut << 4 | (side > 0 ? cut : along) << 8;
        }
        result.count += int(keep) + int(cross);
        corner = next;
        side = next_side;
    }
    return result;
}

// Floor and ceiling of a texture coordinate at a corner, in texels.
ivec2 mask_texel_at(dvec3 corner, ivec3 coordinate, int texel_side) {
    const double estimate = dot(corner, dvec3(coordinate)) / ((corner.x + corner.y + corner.z) * double(texel_side));
    const int nearest = int(round(estimate));
    const int side = mask_side(coordinate - nearest * texel_side, corner);
    return ivec2(side < 0 ? nearest - 1 : nearest, side > 0 ? nearest + 1 : nearest);
}

// The texels of the image that correspond, along one axis, to a range of texels of the plane
// (MATERIAL_WRAP_*): one piece or two. An empty piece has its end before its start.
void mask_pieces(ivec2 range, int period, int size, uint mode, out ivec2 pieces[2]) {
    pieces[1] = ivec2(0, -1);
    if (mode == 2u) {
        const int start = int(clamp(-double(period) * double(size), -1073741824.0LF, 1073741824.0LF));
        pieces[0] = clamp(range - start, 0, size - 1);
        return;
    }
    // The repeat that each end falls in, rounded down. GLSL does not define the division of negative numbers.
    const ivec2 repeat = ivec2(range.x >= 0 ? range.x / size : -((-1 - range.x) / size) - 1,
                               range.y >= 0 ? range.y / size : -((-1 - range.y) / size) - 1);
    const ivec2 place = range - repeat * size;
    if (repeat.y - repeat.x > 1) {
        pieces[0] = ivec2(0, size - 1);
        return;
    }
    const bool split = repeat.y > repeat.x;
    pieces[0] = ivec2(place.x, split ? size - 1 : place.y);
    if (split) pieces[1] = ivec2(0, place.y);
    if (mode == 1u) {
        const bool odd = ((repeat.x + period) & 1) != 0;
        if (odd) pieces[0] = size - 1 - pieces[0].yx;
        else if (split) pieces[1] = size - 1 - pieces[1].yx;
    }
}

uint mask_count_before(SurfaceMaterial material, int x, int y) {
    return surface_texel(material.passing_offset + uint(y) * (material.width + 1u) + uint(x));
}

// Whether all texels of a rectangle pass (MASK_SURFACE), none (MASK_EMPTY), or some (MASK_UNDECIDED).
int mask_some_pass(MaskedTriangle m, ivec2 columns, ivec2 rows) {
    ivec2 x[2], y[2];
    mask_pieces(columns, m.period.x, int(m.material.width), m.material.flags >> MATERIAL_WRAP_S_SHIFT & 3u, x);
    mask_pieces(rows, m.period.y, int(m.material.height), m.material.flags >> MATERIAL_WRAP_T_SHIFT & 3u, y);
    uint passing = 0u;
    uint all = 0u;
    for (int i = 0; i < 4; ++i) {
        const ivec2 across = (i & 1) != 0 ? x[1] : x[0];
        const ivec2 down = (i & 2) != 0 ? y[1] : y[0];
        if (across.x > across.y || down.x > down.y) continue;
        passing += mask_count_before(m.material, across.y + 1, down.y + 1) -
                   mask_count_before(m.material, across.x, down.y + 1) -
                   mask_count_before(m.material, across.y + 1, down.x) +
                   mask_count_before(m.material, across.x, down.x);
        all += uint(across.y - across.x + 1) * uint(down.y - down.x + 1);
    }
    return passing == 0u ? MASK_EMPTY : passing == all ? MASK_SURFACE : MASK_UNDECIDED;
}

// Sets the lines of the triangle's sides and of the voxel, and the triangle as the first polygon.
void mask_begin(MaskedTriangle m, ivec3 voxel, int shift) {
    const ivec3 low = voxel << shift;
    const ivec3 high = low + (1 << shift);
    mask_lines[0] = ivec3(1, 0, 0);
    mask_lines[1] = ivec3(0, 1, 0);
    mask_lines[2] = ivec3(0, 0, 1);
    mask_lines[3] = m.x - low.x;
    mask_lines[4] = high.x - m.x;
    mask_lines[5] = m.y - low.y;
    mask_lines[6] = high.y - m.y;
    mask_lines[7] = m.z - low.z;
    mask_lines[8] = high.z - m.z;
    mask_corners[0] = 1u | 2u << 4 | 2u << 8;
    mask_corners[1] = 2u | 0u << 4 | 0u << 8;
    mask_corners[2] = 0u | 1u << 4 | 1u << 8;
}

// A rectangle around the texels that a polygon touches.
struct MaskRange {
    ivec2 first, last;
};

MaskRange mask_range(MaskedTriangle m, MaskPolygon polygon) {
    MaskRange range = MaskRange(ivec2(2147483647), ivec2(-2147483647));
    for (int i = 0; i < polygon.count; ++i) {
        const dvec3 corner = mask_corner(mask_corners[polygon.place * MASK_MAX_CORNERS + i]);
        const ivec2 column = mask_texel_at(corner, m.u, m.texel_side);
        const ivec2 row = mask_texel_at(corner, m.v, m.texel_side);
        range.first = min(range.first, ivec2(column.y, row.y) - 1);
        range.last = max(range.last, ivec2(column.x, row.x));
    }
    return range;
}

// MASK_EMPTY, MASK_SURFACE or MASK_UNDECIDED. The first step counts the texels that pass in the rectangle
// around the triangle's part inside the voxel. While some pass and some do not, the part is cut in strips of
// 2^level rows, and strips without a texel that passes are skipped. A convex part in one row or column
// touches all texels from the first to the last.
int mask_decide(MaskedTriangle m, ivec3 voxel, int shift) {
    if (m.material.width == 0u || m.alpha != ivec3(65535)) return MASK_UNDECIDED;
    mask_begin(m, voxel, shift);
    MaskPolygon inside = MaskPolygon(0, 3);
    ivec2 all_rows = ivec2(0), strip = ivec2(-2147483647, 2147483647);
    int level = 0, top_level = 0;
    for (int step = 0; step < MASK_STEPS; ++step) {
        MaskPolygon part = inside;
        const int last_line = step == 0 ? MASK_ROW_LINES : MASK_LINE_COUNT;
        for (int line = step == 0 ? MASK_VOXEL_LINES : MASK_ROW_LINES; line < last_line; ++line) {
            part = mask_clip(part, line, inside.place);
        }
        const MaskRange range = mask_range(m, part);
        const ivec2 columns = ivec2(range.first.x, range.last.x);
        const ivec2 rows = ivec2(max(range.first.y, strip.x), min(range.last.y, strip.y));
        const int some = part.count == 0 ? MASK_EMPTY : mask_some_pass(m, columns, rows);
        if (some == MASK_SURFACE) return MASK_SURFACE;
        if (some == MASK_EMPTY) {
            if (step == 0) return MASK_EMPTY;
            strip.x += 1 << level;
            if (strip.x > all_rows.y) return MASK_EMPTY;
            level = min(findLSB(strip.x - all_rows.x), top_level);
        } else {
            if (rows.x == rows.y || columns.x == columns.y) return MASK_SURFACE;
            if (step == 0) {
                inside = part;
                all_rows = rows;
                top_level = findMSB(rows.y - rows.x);
                level = top_level;
                strip.x = rows.x;
            } else {
                --level;
            }
        }
        strip.y = min(strip.x + (1 << level) - 1, all_rows.y);
        mask_lines[MASK_ROW_LINES] = m.v - strip.x * m.texel_side;
        mask_lines[MASK_ROW_LINES + 1] = (strip.y + 1) * m.texel_side - m.v;
    }
    return MASK_UNDECIDED;
}

// Whether a voxel is surface; if that is undecided, it counts as surface.
bool mask_touches(uint triangle, ivec3 voxel, int shift) {
    return mask_decide(masked_triangle(triangle), voxel, shift) != MASK_EMPTY;
}

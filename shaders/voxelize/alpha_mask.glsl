// Whether the part of a masked triangle inside a closed voxel touches a closed texel square that passes the cutoff:
// exact on every driver. The definition in few lines is voxelizer/exact_mask.h.
//
//     bool mask_touches(uint triangle, ivec3 voxel, int shift)        voxel of side 2^shift that the triangle meets,
//                                                                     numbered in the root cube
//     MaskedTriangle masked_triangle(uint triangle);                  the same in two steps, for many voxels
//     bool mask_touches(MaskedTriangle m, ivec3 voxel, int shift)
//
// A point of the triangle is its three weights. Sides of the voxel, of a texel, and of the triangle are lines that are
// linear and homogeneous in the weights, with whole coefficients under 2^25.6. The part inside the voxel is a polygon
// whose corners are each the cross product of two such lines: whole numbers, and exact, because the voxel's and the
// texel's sides are used only where they cut the triangle: then a component of the product is twice an area that lies in
// the bounding box, at most 9 * 2^48. The side of a corner is a sum of three products of 77 bits: the corner is cut in
// two halves, each sum is exact in double, and the two are compared.
// Clipping: Sutherland and Hodgman 1974, closed: what only touches is left as a segment or a point.
#include "voxelize/surface.glsl"
#include "voxelize/surface_attributes.glsl"

#define MASK_MAX_CORNERS 14  // three, and one more for each line: six of the voxel, four of a texel, the cutoff
const double MASK_SPLIT = 67108864.0LF;  // 2^26

struct MaskedTriangle {
    ivec3 x, y, z;        // of its vertices, on the lattice
    ivec3 u, v;           // in units of 1 / texel_side texels, whole textures taken off
    ivec3 alpha;          // 0 to 255
    ivec2 period;         // the textures taken off
    int texel_side;
    SurfaceMaterial material;
};

struct MaskPolygon {
    int count;
    dvec3 corners[MASK_MAX_CORNERS];
    dvec3 lines[MASK_MAX_CORNERS];   // from this corner to the next
};

MaskedTriangle masked_triangle(uint triangle) {
    const uvec4 corners = surface_triangles[triangle].vertices_material;
    MaskedTriangle m;
    const ivec3 a = surface_position(corners.x), b = surface_position(corners.y), c = surface_position(corners.z);
    m.x = ivec3(a.x, b.x, c.x);
    m.y = ivec3(a.y, b.y, c.y);
    m.z = ivec3(a.z, b.z, c.z);
    m.material = surface_materials[corners.w];
    m.alpha = ivec3(attributes[corners.x].color >> 24, attributes[corners.y].color >> 24,
                    attributes[corners.z].color >> 24);
    const vec2 ta = attributes[corners.x].texcoord, tb = attributes[corners.y].texcoord,
               tc = attributes[corners.z].texcoord;
    // Coordinates are multiples of 1 / TEXCOORD_UNITS, so that differences are exact, and one rounding is left.
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

// The sign of a line at a corner.
int mask_side(dvec3 line, dvec3 corner) {
    const dvec3 high = floor(corner / MASK_SPLIT);
    const dvec3 low = corner - high * MASK_SPLIT;
    const double a = (line.x * high.x + line.y * high.y + line.z * high.z) * MASK_SPLIT;
    const double b = -(line.x * low.x + line.y * low.y + line.z * low.z);
    return int(a > b) - int(a < b);
}

dvec3 mask_crossing(dvec3 a, dvec3 b) {
    const dvec3 p = dvec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return p.x + p.y + p.z < 0.0LF ? -p : p;
}

// Cuts away what is on the negative side of a line.
void mask_clip(inout MaskPolygon polygon, ivec3 whole_line) {
    if (all(greaterThanEqual(whole_line, ivec3(0)))) return;
    const dvec3 line = dvec3(whole_line);
    if (polygon.count == 0 || all(lessThan(whole_line, ivec3(0)))) {
        polygon.count = 0;
        return;
    }
    MaskPolygon kept;
    kept.count = 0;
    const int first_side = mask_side(line, polygon.corners[0]);
    int side = first_side;
    for (int i = 0; i < polygon.count; ++i) {
        const int next = i + 1 < polygon.count ? mask_side(line, polygon.corners[min(i + 1, MASK_MAX_CORNERS - 1)])
                                               : first_side;
        if (side >= 0) {
            kept.corners[kept.count] = polygon.corners[i];
            kept.lines[kept.count++] = side == 0 && next < 0 ? line : polygon.lines[i];
        }
        if (side * next < 0) {
            kept.corners[kept.count] = mask_crossing(polygon.lines[i], line);
            kept.lines[kept.count++] = side > 0 ? line : polygon.lines[i];
        }
        side = next;
    }
    polygon = kept;
}

// The part of the triangle inside a voxel.
MaskPolygon mask_polygon(MaskedTriangle m, ivec3 voxel, int shift) {
    MaskPolygon polygon;
    polygon.count = 3;
    polygon.corners[0] = dvec3(1.0LF, 0.0LF, 0.0LF);
    polygon.corners[1] = dvec3(0.0LF, 1.0LF, 0.0LF);
    polygon.corners[2] = dvec3(0.0LF, 0.0LF, 1.0LF);
    polygon.lines[0] = polygon.corners[2];
    polygon.lines[1] = polygon.corners[0];
    polygon.lines[2] = polygon.corners[1];
    const ivec3 low = voxel << shift;
    const ivec3 high = low + (1 << shift);
    mask_clip(polygon, m.x - low.x);
    mask_clip(polygon, high.x - m.x);
    mask_clip(polygon, m.y - low.y);
    mask_clip(polygon, high.y - m.y);
    mask_clip(polygon, m.z - low.z);
    mask_clip(polygon, high.z - m.z);
    return polygon;
}

// floor and ceil of a texture coordinate at a corner, in texels.
ivec2 mask_texel_at(dvec3 corner, ivec3 coordinate, int texel_side) {
    const double estimate = dot(corner, dvec3(coordinate)) / ((corner.x + corner.y + corner.z) * double(texel_side));
    const int nearest = int(round(estimate));
    const int side = mask_side(dvec3(coordinate - nearest * texel_side), corner);
    return ivec2(side < 0 ? nearest - 1 : nearest, side > 0 ? nearest + 1 : nearest);
}

// The texels that a polygon touches along one axis: first and last.
ivec2 mask_texels(MaskPolygon polygon, ivec3 coordinate, int texel_side) {
    ivec2 range = ivec2(2147483647, -2147483647);
    for (int i = 0; i < polygon.count; ++i) {
        const ivec2 texel = mask_texel_at(polygon.corners[i], coordinate, texel_side);
        range = ivec2(min(range.x, texel.y - 1), max(range.y, texel.x));
    }
    return range;
}

// A texel's number in the image (MATERIAL_WRAP_*).
int mask_wrapped(int texel, int period, int size, uint mode) {
    if (mode == 2u) {
        return int(clamp(double(texel) + double(period) * double(size), 0.0LF, double(size - 1)));
    }
    int place = texel % size;  // of negative numbers GLSL leaves it open
    if (texel < 0) place = (size - 1) - (-(texel + 1)) % size;
    const int repeats = (texel - place) / size + (period & 1);
    return mode == 1u && (repeats & 1) != 0 ? size - 1 - place : place;
}

// A range of texels that holds the same ones as a longer range.
ivec2 mask_distinct(ivec2 range, int period, int size, uint mode) {
    if (mode != 2u) return ivec2(range.x, min(range.y, range.x + 2 * size - 1));
    const int edge = int(clamp(-double(period) * double(size), -1073741824.0LF, 1073741824.0LF));
    return clamp(range, ivec2(edge), ivec2(edge + size - 1));
}

ivec2 mask_distinct_columns(MaskedTriangle m, ivec2 columns) {
    const uint mode = m.material.flags >> MATERIAL_WRAP_S_SHIFT & 3u;
    return mask_distinct(columns, m.period.x, max(int(m.material.width), 1), mode);
}
ivec2 mask_distinct_rows(MaskedTriangle m, ivec2 rows) {
    const uint mode = m.material.flags >> MATERIAL_WRAP_T_SHIFT & 3u;
    return mask_distinct(rows, m.period.y, max(int(m.material.height), 1), mode);
}

int mask_alpha(MaskedTriangle m, ivec2 texel) {
    if (m.material.width == 0u) return 255;
    const int x = mask_wrapped(texel.x, m.period.x, int(m.material.width), m.material.flags >> MATERIAL_WRAP_S_SHIFT & 3u);
    const int y = mask_wrapped(texel.y, m.period.y, int(m.material.height), m.material.flags >> MATERIAL_WRAP_T_SHIFT & 3u);
    return int(texels[m.material.texel_offset + uint(y) * m.material.width + uint(x)] >> 24);
}

// Where the interpolated alpha passes the cutoff, as a line.
ivec3 mask_passing_line(MaskedTriangle m, ivec2 texel) {
    return mask_alpha(m, texel) * 256 * m.alpha - int(m.material.alpha_threshold);
}

// Whether any corner of the polygon lies where the texel passes. Exact when the polygon lies inside the texel.
bool mask_passes(MaskPolygon polygon, ivec3 passing_line) {
    if (all(greaterThanEqual(passing_line, ivec3(0)))) return polygon.count > 0;
    if (all(lessThan(passing_line, ivec3(0)))) return false;
    for (int i = 0; i < polygon.count; ++i) {
        if (mask_side(dvec3(passing_line), polygon.corners[i]) >= 0) return true;
    }
    return false;
}

// Whether a polygon that lies in one row of texels touches one that passes.
bool mask_row_touches(MaskedTriangle m, MaskPolygon strip, int row) {
    const bool same_alpha = m.alpha.x == m.alpha.y && m.alpha.x == m.alpha.z;
    ivec2 columns = mask_texels(strip, m.u, m.texel_side);
    if (same_alpha) columns = mask_distinct_columns(m, columns);
    for (int column = columns.x; column <= columns.y; ++column) {
        const ivec3 passing_line = mask_passing_line(m, ivec2(column, row));
        if (all(lessThan(passing_line, ivec3(0)))) continue;
        if (same_alpha || all(greaterThanEqual(passing_line, ivec3(0)))) return true;
        MaskPolygon inside = strip;
        mask_clip(inside, m.u - column * m.texel_side);
        mask_clip(inside, (column + 1) * m.texel_side - m.u);
        if (mask_passes(inside, passing_line)) return true;
    }
    return false;
}

// Two cheap answers before the exact rows: a corner of the polygon lies on a texel that passes (1), no texel of its
// bounding box passes (0); else -1.
int mask_quick_answer(MaskedTriangle m, MaskPolygon polygon, ivec2 columns, ivec2 rows) {
    for (int i = 0; i < polygon.count; ++i) {
        const ivec2 texel = ivec2(mask_texel_at(polygon.corners[i], m.u, m.texel_side).x,
                                  mask_texel_at(polygon.corners[i], m.v, m.texel_side).x);
        if (mask_side(dvec3(mask_passing_line(m, texel)), polygon.corners[i]) >= 0) return 1;
    }
    for (int row = rows.x; row <= rows.y; ++row) {
        for (int column = columns.x; column <= columns.y; ++column) {
            if (any(greaterThanEqual(mask_passing_line(m, ivec2(column, row)), ivec3(0)))) return -1;
        }
    }
    return 0;
}

bool mask_touches(MaskedTriangle m, ivec3 voxel, int shift) {
    const MaskPolygon polygon = mask_polygon(m, voxel, shift);
    if (polygon.count == 0) return false;
    const ivec2 columns = mask_texels(polygon, m.u, m.texel_side);
    const ivec2 rows = mask_texels(polygon, m.v, m.texel_side);
    const int quick = mask_quick_answer(m, polygon, mask_distinct_columns(m, columns), mask_distinct_rows(m, rows));
    if (quick >= 0) return quick == 1;
    for (int row = rows.x; row <= rows.y; ++row) {
        MaskPolygon strip = polygon;
        mask_clip(strip, m.v - row * m.texel_side);
        mask_clip(strip, (row + 1) * m.texel_side - m.v);
        if (strip.count > 0 && mask_row_touches(m, strip, row)) return true;
    }
    return false;
}

bool mask_touches(uint triangle, ivec3 voxel, int shift) {
    return mask_touches(masked_triangle(triangle), voxel, shift);
}

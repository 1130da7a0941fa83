// One thread is one texel of a coarser level of the pyramid: the OR of the texels of its 2 x 2 finer columns
// (Forest et al. 2009, section 2.3, Figure 4(a)). Columns keep all their bits.
#include "interop/columns.h"
#include "shadow/columns.glsl"
#include "common/thread.glsl"

// Texels of the levels from level 1 on.
layout(std430, binding = SSBO_COLUMNS) restrict writeonly buffer Coarse { uvec4 coarse[]; };

uniform int level;  // the level that is built

void main() {
    const int thread = int(thread_index());
    const int side = COLUMN_SIDE >> level;
    if (thread >= side * side * COLUMN_TEXELS) return;
    const int texel = thread % COLUMN_TEXELS;
    const int number = thread / COLUMN_TEXELS;
    const ivec2 place = 2 * ivec2(number % side, number / side);
    const int fine = level - 1;
    coarse[column_at(level, ivec2(0)) - column_at(1, ivec2(0)) + thread] =
        texelFetch(columns, column_at(fine, place) + texel) |
        texelFetch(columns, column_at(fine, place + ivec2(1, 0)) + texel) |
        texelFetch(columns, column_at(fine, place + ivec2(0, 1)) + texel) |
        texelFetch(columns, column_at(fine, place + ivec2(1, 1)) + texel);
}

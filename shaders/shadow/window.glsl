// Windows: the place of a map as seen from the light. In light space the light's centre is the origin, its
// half axes lie along x and y, and it shines along +z. A point is given by its tangents (x, y) / z and its
// inverse depth w = 1 / z: straight lines stay straight, w is linear across a triangle on the map, and the
// share of the light that a micro-patch hides takes one division. A window is the rectangle of tangents that
// a map covers: low.xy, high.xy in .xyzw.

// The tangents of a place in texels. The high edge of a texel and the low edge of the next one are computed
// by the same expression, so that patches meet without gap or overlap.
vec2 tangents_at(vec4 window, vec2 texel, float size) {
    return mix(window.xy, window.zw, texel / size);
}

vec2 texels_at(vec4 window, vec2 tangents, float size) {
    return (tangents - window.xy) / (window.zw - window.xy) * size;
}

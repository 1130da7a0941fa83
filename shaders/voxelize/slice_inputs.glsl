// What the fragments of a primitive share: see Projection in projection.glsl. VARYING: in or out.
flat VARYING vec3 slice_plane;
flat VARYING vec2 slice_limits;
flat VARYING vec3 slice_side_a;
flat VARYING vec3 slice_side_b;
flat VARYING vec3 slice_side_c;
flat VARYING vec4 slice_box;
flat VARYING vec3 slice_weight_b;
flat VARYING vec3 slice_weight_c;
flat VARYING uint slice_primitive;  // place in its list

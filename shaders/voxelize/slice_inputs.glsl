// Values that all fragments of a primitive share (Projection of projection.glsl). VARYING: in or out.
flat VARYING vec3 slice_plane;
flat VARYING vec2 slice_limits;
flat VARYING vec3 slice_side_a;
flat VARYING vec3 slice_side_b;
flat VARYING vec3 slice_side_c;
flat VARYING vec4 slice_box;
flat VARYING vec3 slice_weight_b;
flat VARYING vec3 slice_weight_c;
flat VARYING uint slice_primitive;  // place of the primitive in its list

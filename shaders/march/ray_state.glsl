// A ray between two passes.
uvec2 pack_voxel(ivec3 v) {
    const uvec3 u = uvec3(v);
    return uvec2(u.x | u.y << 21, u.y >> 11 | u.z << 10);
}
ivec3 unpack_voxel(uvec2 p) {
    return ivec3(p.x & 0x1FFFFFu, p.x >> 21 | (p.y & 0x3FFu) << 11, p.y >> 10 & 0x1FFFFFu);
}

void store_position(inout RayState state, Ray ray) {
    state.voxel_t_weight.xy = pack_voxel(ray.voxel);
    state.voxel_t_weight.z = floatBitsToUint(ray.t);
}
void load_position(inout Ray ray, RayState state) {
    ray.voxel = unpack_voxel(state.voxel_t_weight.xy);
    ray.t = uintBitsToFloat(state.voxel_t_weight.z);
}

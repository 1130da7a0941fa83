// A ray between two passes.
#if WINDOWS
// 17 bits a coordinate, then 6 for the ray's window and 6 for the seen voxel's. The last bit stays 0.
uvec2 pack_place(ivec3 v, int window) {
    const uvec3 u = uvec3(v);
    return uvec2(u.x | u.y << 17, u.y >> 15 | u.z << 2 | uint(window) << 19 | uint(seen_window) << 25);
}

void store_position(inout RayState state, Ray ray) {
    state.voxel_t_weight.xy = pack_place(ray.voxel, ray.window);
    state.voxel_t_weight.z = floatBitsToUint(ray.t);
}
int stored_seen_window(RayState state) { return int(state.voxel_t_weight.y >> 25 & 63u); }
// The ray is as it started, in the window where it did.
void load_position(inout Ray ray, RayState state) {
    const uvec2 p = state.voxel_t_weight.xy;
    const int window = int(p.y >> 19 & 63u);
    while (ray.window < window) coarsen(ray);
    ray.voxel = ivec3(p.x & 0x1FFFFu, p.x >> 17 | (p.y & 3u) << 15, p.y >> 2 & 0x1FFFFu);
    ray.t = uintBitsToFloat(state.voxel_t_weight.z);
    seen_window = stored_seen_window(state);
}
#else
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
#endif

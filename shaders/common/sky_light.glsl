// The share of the light from everywhere (Light::ambient) that a surface with this unit normal gets: all of
// it if the surface faces up, half of it if the surface faces down.
float sky_share(vec3 normal) { return 0.75 + 0.25 * normal.y; }

#include "scenes/gltf/unroll.h"

#include <tiny_gltf.h>

namespace cairn::scenes::gltf {

std::optional<Topology> topology_of(int mode) {
    switch (mode) {
        case TINYGLTF_MODE_POINTS:
            return Topology::points;
        case TINYGLTF_MODE_LINE:
        case TINYGLTF_MODE_LINE_LOOP:
        case TINYGLTF_MODE_LINE_STRIP:
            return Topology::lines;
        case TINYGLTF_MODE_TRIANGLES:
        case TINYGLTF_MODE_TRIANGLE_STRIP:
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return Topology::triangles;
        default:
            return std::nullopt;
    }
}

std::uint64_t unrolled_count(std::uint64_t n, int mode) {
    switch (mode) {
        case TINYGLTF_MODE_LINE:
            return n - n % 2;
        case TINYGLTF_MODE_LINE_LOOP:
            return n < 2 ? 0 : 2 * n;
        case TINYGLTF_MODE_LINE_STRIP:
            return n < 2 ? 0 : 2 * (n - 1);
        case TINYGLTF_MODE_TRIANGLES:
            return n - n % 3;
        case TINYGLTF_MODE_TRIANGLE_STRIP:
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return n < 3 ? 0 : 3 * (n - 2);
        default:
            return n;
    }
}

std::vector<std::uint32_t> unroll(std::vector<std::uint32_t> indices, int mode) {
    const std::size_t count = unrolled_count(indices.size(), mode);
    if (mode == TINYGLTF_MODE_POINTS || mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_TRIANGLES) {
        indices.resize(count);
        return indices;
    }
    std::vector<std::uint32_t> list;
    list.reserve(count);
    for (std::size_t i = 0; list.size() < count; ++i) {
        if (mode == TINYGLTF_MODE_LINE_STRIP || mode == TINYGLTF_MODE_LINE_LOOP)
            list.insert(list.end(), {indices[i], indices[(i + 1) % indices.size()]});
        else if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            list.insert(list.end(), {indices[0], indices[i + 1], indices[i + 2]});
        else  // every other triangle of a strip is turned round
            list.insert(list.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    }
    return list;
}

}  // namespace cairn::scenes::gltf

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"
#include "scenes/gltf/draco.h"
#include "scenes/gltf/failure.h"
#include "scenes/gltf/reader.h"
#include "scenes/gltf/unroll.h"
#include "scenes/gltf/vertices.h"

namespace cairn::scenes::gltf {
namespace {

constexpr std::uint64_t most_vertices = 1ULL << 31U;

DracoMesh unpack_draco(Reader& reader, const std::string& where, const tinygltf::Primitive& source,
                       const tinygltf::Value& compression) {
    if (source.mode != TINYGLTF_MODE_TRIANGLES && source.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
        fail(where, fmt::format("KHR_draco_mesh_compression cannot hold mode {}", source.mode));
    const tinygltf::Value& ids = compression.Get("attributes");
    std::map<std::string, std::pair<Elements, int>> wanted;
    for (const std::string& name : ids.Keys()) {
        const auto accessor = source.attributes.find(name);
        if (accessor == source.attributes.end())
            fail(where, fmt::format("Draco's attribute {} has no accessor", in_quotes(name)));
        const tinygltf::Value& id = ids.Get(name);
        if (!id.IsInt() || id.GetNumberAsInt() < 0)
            fail(where, fmt::format("the id of Draco's attribute {} is no whole number", in_quotes(name)));
        wanted.emplace(name, std::pair(reader.accessors.shape(where, accessor->second), id.GetNumberAsInt()));
    }
    return decode_draco(where + ", KHR_draco_mesh_compression",
                        reader.buffers.view(compression.Get("bufferView").GetNumberAsInt()), wanted,
                        reader.budget);
}

/// The vertices in drawing order, as the file lists them or counted up.
std::vector<std::uint32_t> read_order(Reader& reader, const std::string& where, int indices_accessor,
                                      std::uint64_t vertex_count, int mode) {
    std::vector<std::uint32_t> order;
    if (indices_accessor < 0) {
        reader.budget.charge(where, unrolled_count(vertex_count, mode), sizeof(std::uint32_t));
        order.resize(vertex_count);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    const Elements elements = reader.accessors.elements(where, indices_accessor);
    if (elements.width != 1) fail(elements.where, "indices must be SCALAR");
    reader.budget.charge(where, unrolled_count(elements.count, mode), sizeof(std::uint32_t));
    order.resize(elements.count);
    read_integers(elements, {}, 1, order.data());
    return order;
}

void check_order(const std::string& where, const std::vector<std::uint32_t>& order,
                 std::uint64_t vertex_count) {
    for (std::size_t i = 0; i < order.size(); ++i)
        if (order[i] >= vertex_count)
            fail(where,
                 fmt::format("index {} is {}, the primitive has {} vertices", i, order[i], vertex_count));
}

/// Many primitives may share one big set of vertices and use a part of it each. Only that part is kept:
/// `indices` are renumbered, and the answer lists the old numbers. Empty = all vertices are kept.
std::vector<std::uint32_t> keep_used(std::vector<std::uint32_t>& indices, std::uint64_t vertex_count) {
    if (indices.size() >= vertex_count / 2) return {};
    std::vector<std::uint32_t> used = indices;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& index : indices)
        index = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), index) - used.begin());
    return used;
}

/// @return false: there is nothing to draw.
bool read_primitive(Reader& reader, const std::string& where, const tinygltf::Primitive& source,
                    Primitive& result) {
    const auto topology = topology_of(source.mode);
    if (!topology) fail(where, fmt::format("\"mode\" is {}, glTF has 0 to 6", source.mode));
    const auto position = source.attributes.find("POSITION");
    if (position == source.attributes.end()) {
        reader.warn(where + ": it has no POSITION and is not drawn");
        return false;
    }
    DracoMesh draco;
    const auto compression = source.extensions.find("KHR_draco_mesh_compression");
    const bool packed = compression != source.extensions.end();
    if (packed) draco = unpack_draco(reader, where, source, compression->second);

    VertexSource vertices{reader, where, source.attributes, draco.attributes, {}, {}, 0};
    vertices.positions = vertices.elements("POSITION");
    const std::uint64_t vertex_count = vertices.positions.count;
    if (vertex_count >= most_vertices)
        fail(where, fmt::format("it has {} vertices, the limit is 2^31", vertex_count));
    auto order = packed ? std::move(draco.indices)
                        : read_order(reader, where, source.indices, vertex_count, source.mode);
    check_order(where, order, vertex_count);
    result.topology = *topology;
    result.material = source.material;
    result.indices = packed ? std::move(order) : unroll(std::move(order), source.mode);
    if (result.indices.empty()) return false;
    vertices.kept = keep_used(result.indices, vertex_count);
    vertices.count = vertices.kept.empty() ? vertex_count : vertices.kept.size();
    read_vertices(vertices, result);
    read_morph_targets(vertices, source.targets, result);
    return true;
}

Mesh read_mesh(Reader& reader, const std::string& where, const tinygltf::Mesh& source) {
    Mesh mesh;
    mesh.name = source.name;
    std::size_t target_count = 0;
    for (const tinygltf::Primitive& primitive : source.primitives)
        target_count = std::max(target_count, primitive.targets.size());
    for (std::size_t p = 0; p < source.primitives.size(); ++p) {
        const std::string place = fmt::format("{}, primitive {}", where, p);
        // glTF asks for as many; what the first ones move is clear without the others.
        if (const std::size_t count = source.primitives[p].targets.size(); count != target_count)
            reader.warn(fmt::format("{}: it has {} morph targets, another primitive has {}", place, count,
                                    target_count));
        Primitive primitive;
        if (read_primitive(reader, place, source.primitives[p], primitive))
            mesh.primitives.push_back(std::move(primitive));
    }
    mesh.morph_weights = read_morph_weights(reader, where, source.weights, target_count);
    if (mesh.morph_weights.empty()) mesh.morph_weights.assign(target_count, 0.0F);
    return mesh;
}

}  // namespace

void read_meshes(Reader& reader) {
    const auto& sources = reader.source.model.meshes;
    for (std::size_t m = 0; m < sources.size(); ++m) {
        const std::string where = reader.source.where(element("mesh", m, sources[m].name));
        Mesh& mesh = reader.scene.meshes.emplace_back();
        try {
            mesh = read_mesh(reader, where, sources[m]);
        } catch (const Error& error) {
            if (reader.is_placed(m) || error.fault() != Fault::input) throw;
            mesh.name = sources[m].name;
            reader.warn(std::string(error.what()) + "; no node has this mesh, which was left out");
        }
        reader.joints_needed.push_back(joints_needed_by(mesh));
    }
}

}  // namespace cairn::scenes::gltf

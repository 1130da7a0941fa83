#include "voxelizer/surface/moving_chunk.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "gl/limits.h"
#include "voxelizer/surface/upload_array.h"

namespace cairn::voxelizer {
namespace {

using Vector = std::array<float, 3>;

/// Appends the vectors of a run's vertices. @return the number of the first, or DEFORM_NONE where the
/// attribute is absent.
std::uint32_t append_vectors(std::vector<Vector>& vectors, const std::vector<glm::vec3>& values,
                             std::size_t vertex_count, std::span<const SurfaceSource> run) {
    if (values.empty() || values.size() != vertex_count) return DEFORM_NONE;
    const auto first = std::uint32_t(vectors.size());
    for (const SurfaceSource& source : run) {
        const glm::vec3& value = values[source.vertex];
        vectors.push_back({value.x, value.y, value.z});
    }
    return first;
}

/// Appends the sets of a vertex, with the influences of weight 0 left for the end. They add nothing, so the
/// sum is the same.
void append_influences(std::vector<interop::DeformInfluences>& sets, const scenes::Primitive& primitive,
                       std::uint32_t vertex) {
    const std::size_t first = sets.size();
    sets.resize(first + 1 + primitive.more_skin.size());
    std::size_t next = 0;
    const auto append = [&](const scenes::SkinWeights& skin) {
        for (int i = 0; i < 4; ++i) {
            if (skin.weights[i] == 0.0F) continue;
            interop::DeformInfluences& set = sets[first + next / 4];
            set.joints[next % 4 / 2] |= std::uint32_t(skin.joints[i]) << (16 * (next % 2));
            set.weights[next % 4] = skin.weights[i];
            ++next;
        }
    };
    append(primitive.skin[vertex]);
    for (const auto& set : primitive.more_skin)
        append(set[vertex]);
}

}  // namespace

struct MovingChunk::Arrays {
    std::vector<std::array<std::uint32_t, 4>> vertices;
    std::vector<Vector> vectors;
    std::vector<interop::DeformInfluences> influences;
    std::vector<interop::DeformItem> items;
};

MovingChunk::MovingChunk(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                         const SurfaceChunk& chunk, std::span<const std::uint32_t> first_joints, bool normals)
    : vertex_count_(std::uint32_t(chunk.sources.size())) {
    Arrays arrays;
    arrays.vertices.reserve(chunk.sources.size());
    const std::span<const SurfaceSource> sources(chunk.sources);
    for (std::size_t first = 0; first < sources.size();) {
        std::size_t last = first;
        while (last < sources.size() && sources[last].item == sources[first].item)
            ++last;
        add_run(snapshot, sources.subspan(first, last - first), first_joints, scene, normals, arrays);
        first = last;
    }
    const std::size_t limit = gl::query_limits().shader_storage_bytes;
    vertices_ = upload_array(arrays.vertices, "vertices at rest", limit);
    vectors_ = upload_array(arrays.vectors, "normals and morph targets", limit);
    influences_ = upload_array(arrays.influences, "skin weights", limit);
    items_ = upload_array(arrays.items, "moving items", limit);
    frame_ = gl::Buffer(
        sizeof(interop::DeformHeader) + std::max<std::size_t>(targets_.size(), 1) * sizeof(targets_[0]),
        "morph weights");
}

void MovingChunk::add_run(const scenes::Snapshot& snapshot, std::span<const SurfaceSource> run,
                          std::span<const std::uint32_t> first_joints, const scenes::Scene& scene,
                          bool normals, Arrays& arrays) {
    const scenes::Item& item = snapshot.items[run.front().item];
    const scenes::Primitive& primitive = *item.primitive;
    interop::DeformItem out{};
    out.first_vertex = std::uint32_t(arrays.vertices.size());
    out.matrix = matrix_of_item(run.front().item);
    out.first_joint = DEFORM_NONE;
    out.first_influence = std::uint32_t(arrays.influences.size());
    out.first_normal = DEFORM_NONE;
    if (normals)
        out.first_normal = append_vectors(arrays.vectors, primitive.normals, primitive.positions.size(), run);
    if (item.skinned) {
        out.first_joint = first_joints[std::size_t(scene.nodes[std::size_t(item.node)].skin)];
        out.set_count = std::uint32_t(1 + primitive.more_skin.size());
    }
    for (const SurfaceSource& source : run) {
        const glm::vec3& p = primitive.positions[source.vertex];
        arrays.vertices.push_back({std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                                   std::bit_cast<std::uint32_t>(p.z), std::uint32_t(arrays.items.size())});
        if (!item.skinned) continue;
        append_influences(arrays.influences, primitive, source.vertex);
    }
    out.first_target = std::uint32_t(targets_.size());
    out.target_count = std::uint32_t(primitive.morph_targets.size());
    add_targets(item, run, out.first_normal != DEFORM_NONE, arrays);
    most_turns_ = std::max<std::size_t>(most_turns_, out.target_count + 4 * std::size_t(out.set_count));
    arrays.items.push_back(out);
}

void MovingChunk::add_targets(const scenes::Item& item, std::span<const SurfaceSource> run, bool normals,
                              Arrays& arrays) {
    const scenes::Primitive& primitive = *item.primitive;
    const std::size_t vertex_count = primitive.positions.size();
    for (std::size_t t = 0; t < primitive.morph_targets.size(); ++t) {
        const scenes::MorphTarget& target = primitive.morph_targets[t];
        interop::DeformTarget out{};
        out.first_position = append_vectors(arrays.vectors, target.positions, vertex_count, run);
        out.first_normal =
            normals ? append_vectors(arrays.vectors, target.normals, vertex_count, run) : DEFORM_NONE;
        targets_.push_back(out);
        weight_sources_.push_back({std::size_t(item.node), t});
    }
}

void MovingChunk::write_frame(const scenes::Scene& scene, const scenes::Pose& pose, const Grid& grid) {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const WeightSource& source = weight_sources_[i];
        const std::span<const float> weights = scenes::morph_weights_of(scene, pose, source.node);
        const float weight = source.target < weights.size() ? weights[source.target] : 0.0F;
        targets_[i].weight = std::isfinite(weight) ? weight : 0.0F;
    }
    const interop::DeformHeader header{
        {grid.origin.x, grid.origin.y, grid.origin.z}, grid.lattice_scale(), 0, 0, 0, 0};
    frame_.write(0, &header, sizeof(header));
    frame_.write(sizeof(header), targets_.data(), targets_.size() * sizeof(targets_[0]));
}

interop::DeformHeader MovingChunk::read_header() const {
    interop::DeformHeader header{};
    frame_.read(0, &header, sizeof(header));
    return header;
}

void MovingChunk::bind() const {
    vertices_.bind_storage(SSBO_DEFORM_VERTICES);
    vectors_.bind_storage(SSBO_DEFORM_VECTORS);
    influences_.bind_storage(SSBO_DEFORM_INFLUENCES);
    items_.bind_storage(SSBO_DEFORM_ITEMS);
    bind_frame();
}

}  // namespace cairn::voxelizer

#include "voxelizer/surface/moving_surface.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "gl/limits.h"
#include "gl/program.h"
#include "scenes/pose.h"
#include "shaders/interop/deform.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"
#include "voxelizer/surface/moving_chunk.h"
#include "voxelizer/surface/upload_array.h"

namespace cairn::voxelizer {
namespace {

constexpr std::size_t matrix_numbers = 12;

}  // namespace

struct MovingSurface::Impl {
    Impl(const scenes::Scene& scene, const scenes::When& when, const Grid& grid,
         const SurfaceOptions& options, const gl::ShaderSource& shaders);
    void move_to(double seconds);

    /// The fields of an item that are the same at every moment.
    struct MovingItem {
        int node, instance;
        bool skinned;
    };
    void add_skins(const scenes::Snapshot& snapshot);
    void write_matrices(const scenes::Pose& pose);
    void write_matrix(std::size_t number, const glm::dmat4& matrix);
    /// Whether the GPU could place every vertex that matters.
    [[nodiscard]] bool deform(const scenes::Pose& pose);
    [[nodiscard]] bool any_far_triangle(std::size_t chunk);

    const scenes::Scene& scene_;
    scenes::When when_;
    Grid grid_;
    SurfaceOptions options_;
    scenes::Poser poser_;
    gl::Program deform_;
    gl::Program find_far_;
    std::vector<MovingItem> items_;
    std::vector<std::uint32_t> first_joints_;  ///< per skin its first matrix; DEFORM_NONE: not used
    std::vector<double> matrices_;             ///< twelve numbers per matrix
    gl::Buffer matrix_buffer_;
    std::vector<MovingChunk> chunks_;
    GpuSurface on_gpu_;
    std::optional<GpuSurface> on_cpu_;
    std::uint64_t triangle_count_ = 0;
};

MovingSurface::Impl::Impl(const scenes::Scene& scene, const scenes::When& when, const Grid& grid,
                          const SurfaceOptions& options, const gl::ShaderSource& shaders)
    : scene_(scene),
      when_(when),
      grid_(grid),
      options_{.attributes = options.attributes, .chunk_triangles = options.chunk_triangles},
      poser_(scene, scenes::animation_of(scene, when)),
      deform_(gl::build_compute(shaders, "voxelize/deform.comp.glsl",
                                {{"NORMALS", options.attributes ? "1" : "0"}})),
      find_far_(gl::build_compute(shaders, "voxelize/find_far.comp.glsl")) {
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene, when);
    const Surface surface = build_surface(
        scene, snapshot, grid,
        {.attributes = options.attributes, .unplaced = true, .chunk_triangles = options.chunk_triangles});
    triangle_count_ = surface.triangle_count;
    on_gpu_ = upload(surface);
    for (const scenes::Item& item : snapshot.items)
        items_.push_back({item.node, item.instance, item.skinned});
    add_skins(snapshot);
    for (const SurfaceChunk& chunk : surface.chunks)
        chunks_.emplace_back(scene, snapshot, chunk, first_joints_, options.attributes);
    matrix_buffer_ =
        upload_array(matrices_, "node and joint matrices", gl::query_limits().shader_storage_bytes);
    move_to(when.seconds);
}

/// Numbers the matrices: those of the items, then those of the joints of each skin in use.
void MovingSurface::Impl::add_skins(const scenes::Snapshot& snapshot) {
    first_joints_.assign(scene_.skins.size(), DEFORM_NONE);
    std::size_t count = MovingChunk::matrix_of_item(items_.size());
    for (const scenes::Item& item : snapshot.items) {
        if (!item.skinned) continue;
        const auto skin = std::size_t(scene_.nodes[std::size_t(item.node)].skin);
        if (first_joints_[skin] != DEFORM_NONE) continue;
        first_joints_[skin] = std::uint32_t(count);
        count += scene_.skins[skin].joints.size();
    }
    matrices_.resize(count * matrix_numbers);
}

void MovingSurface::Impl::write_matrix(std::size_t number, const glm::dmat4& matrix) {
    double* out = &matrices_[number * matrix_numbers];
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row)
            *out++ = matrix[column][row];
    }
}

void MovingSurface::Impl::write_matrices(const scenes::Pose& pose) {
    for (std::size_t i = 0; i < items_.size(); ++i) {
        const MovingItem& item = items_[i];
        if (item.skinned) continue;  // its vertices go straight to the world
        const auto node = std::size_t(item.node);
        const glm::dmat4 world_from_mesh =
            world_from_instance(scene_.nodes[node], pose.world_from_node[node], item.instance);
        const std::size_t number = MovingChunk::matrix_of_item(i);
        write_matrix(number, world_from_mesh);
        if (!options_.attributes) continue;
        const glm::dmat3 for_normals = normal_from_mesh(world_from_mesh);
        for (int column = 0; column < 3; ++column) {
            for (int row = 0; row < 3; ++row)
                matrices_[(number + 1) * matrix_numbers + std::size_t(3 * column + row)] =
                    for_normals[column][row];
        }
    }
    for (std::size_t skin = 0; skin < first_joints_.size(); ++skin) {
        if (first_joints_[skin] == DEFORM_NONE) continue;
        for (std::size_t joint = 0; joint < scene_.skins[skin].joints.size(); ++joint)
            write_matrix(first_joints_[skin] + joint, world_by_joint(scene_.skins[skin], pose, joint));
    }
    matrix_buffer_.write(0, matrices_.data(), matrices_.size() * sizeof(double));
}

bool MovingSurface::Impl::deform(const scenes::Pose& pose) {
    for (const MovingChunk& chunk : chunks_)
        if (chunk.most_turns() > DEFORM_TURNS) return false;
    write_matrices(pose);
    matrix_buffer_.bind_storage(SSBO_DEFORM_MATRICES);
    deform_.use();
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        chunks_[i].write_frame(scene_, pose, grid_);
        chunks_[i].bind();
        on_gpu_.chunks[i].positions.bind_storage(SSBO_SURFACE_POSITIONS);
        on_gpu_.chunks[i].attributes.bind_storage(SSBO_SURFACE_ATTRIBUTES);
        deform_.set("count", chunks_[i].vertex_count());
        gl::dispatch_threads(chunks_[i].vertex_count(), THREADS_PER_GROUP);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        const interop::DeformHeader header = chunks_[i].read_header();
        if (header.lost > 0 || (header.stray > 0 && any_far_triangle(i))) return false;
    }
    return true;
}

bool MovingSurface::Impl::any_far_triangle(std::size_t chunk) {
    on_gpu_.bind(chunk);
    chunks_[chunk].bind_frame();
    find_far_.set("count", on_gpu_.chunks[chunk].triangle_count);
    find_far_.use();
    gl::dispatch_threads(on_gpu_.chunks[chunk].triangle_count, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    return chunks_[chunk].read_header().far_triangles > 0;
}

void MovingSurface::Impl::move_to(double seconds) {
    when_.seconds = seconds;
    on_cpu_.reset();
    if (!deform(poser_.at(seconds)))
        on_cpu_ = upload(build_surface(scene_, scenes::take_snapshot(scene_, when_), grid_, options_));
}

MovingSurface::MovingSurface(const scenes::Scene& scene, const scenes::When& when, const Grid& grid,
                             const SurfaceOptions& options, const gl::ShaderSource& shaders)
    : impl_(std::make_unique<Impl>(scene, when, grid, options, shaders)) {}

MovingSurface::MovingSurface(MovingSurface&&) noexcept = default;
MovingSurface& MovingSurface::operator=(MovingSurface&&) noexcept = default;
MovingSurface::~MovingSurface() = default;

const GpuSurface& MovingSurface::move_to(double seconds) {
    impl_->move_to(seconds);
    return surface();
}

const GpuSurface& MovingSurface::surface() const {
    return impl_->on_cpu_ ? *impl_->on_cpu_ : impl_->on_gpu_;
}

bool MovingSurface::was_on_cpu() const {
    return impl_->on_cpu_.has_value();
}

std::uint64_t MovingSurface::triangle_count() const {
    return impl_->triangle_count_;
}

const Grid& MovingSurface::grid() const {
    return impl_->grid_;
}

}  // namespace cairn::voxelizer

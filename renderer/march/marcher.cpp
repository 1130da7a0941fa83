#include "renderer/march/marcher.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "base/error.h"
#include "gl/buffer_texture.h"
#include "gl/limits.h"
#include "renderer/march/block_starts.h"
#include "renderer/march/shadow_ends.h"
#include "shaders/interop/mesh.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/shadow_rays.h"
#include "shaders/interop/threads.h"

namespace cairn::renderer {
namespace {

/// The most passes in a row in which rays only pause. A ray crosses fewer than 8 cells per voxel, or mark,
/// across the root cube, and takes at most 64 turns in each. With windows, it crosses 16 per voxel of each.
constexpr int most_pauses = (8 << MAX_RESOLUTION_BITS) / TURN_BUDGET * 64 + 1;
constexpr int most_pauses_in_windows = ((16 << WINDOW_TILE_BITS) / TURN_BUDGET + 1) * MAX_WINDOWS;
constexpr std::size_t window_header_bytes = sizeof(glm::ivec4);

/// The options for a tree with windows: rays descend from the tiles of a window, and the eye is never far
/// from those.
MarchOptions options_for(const TreeShape& shape, const MarchOptions& options) {
    MarchOptions fitting = options;
    if (shape.has_windows()) {
        fitting.traversal = Traversal::restart;
        fitting.block_starts = false;
    }
    return fitting;
}

/// Pixels of the blocks that are in the picture.
std::uint32_t pixels_of(std::span<const interop::BlockStart> starts, const glm::ivec2& size) {
    const int blocks = (size.x + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE;
    std::uint32_t pixels = 0;
    for (const interop::BlockStart& start : starts) {
        const glm::ivec2 low =
            glm::ivec2(int(start.block) % blocks, int(start.block) / blocks) * PIXEL_BLOCK_SIDE;
        const glm::ivec2 side = glm::min(size - low, PIXEL_BLOCK_SIDE);
        pixels += std::uint32_t(side.x * side.y);
    }
    return pixels;
}

/// The bits of two numbers in turn: blocks whose numbers are near to each other lie near to each other.
std::uint64_t morton_number(unsigned x, unsigned y) {
    std::uint64_t number = 0;
    for (unsigned bit = 0; bit < 32; ++bit)
        number |= std::uint64_t(x >> bit & 1U) << (2 * bit) | std::uint64_t(y >> bit & 1U) << (2 * bit + 1);
    return number;
}

}  // namespace

Marcher::Marcher(const TreeShape& shape, Channels channels, const MarchOptions& options,
                 const gl::ShaderSource& shaders, ContentProgram content)
    : options_(options_for(shape, options)),
      content_(std::move(content)),
      programs_(
          march_programs({shape, channels, options_.traversal, options_.tile_queries, content_}, shaders)),
      view_(sizeof(interop::MarchView), "view"),
      shadow_ends_(std::size_t(SHADOW_ENDS_SIDE) * SHADOW_ENDS_SIDE * sizeof(float), "ends of shadow rays"),
      queries_(options.query_capacity, options.tile_queries, shape.has_windows(), shaders) {
    if (shape.has_windows())
        windows_ = gl::Buffer(window_header_bytes + MAX_WINDOWS * sizeof(interop::MarchWindow), "windows");
    shadow_ends_texture_ = gl::buffer_texture(GL_R32F, shadow_ends_);
    (void)program(RayKind::primary, PassKind::patient);
    (void)program(RayKind::shadow, PassKind::patient);
}

const gl::Program& Marcher::program(RayKind rays, PassKind kind) {
    const bool is_primary = rays == RayKind::primary;
    return programs_.get({.rays = rays,
                          .progressive = kind != PassKind::patient,
                          .blended = blended_,
                          .meshes = mix_.mesh_nearest != 0,
                          .proxy = is_primary && mix_.proxy_span != 0,
                          .show_tree = is_primary && show_tree_,
                          .soft = !is_primary && soft_shadows_,
                          .cones = !is_primary && shadow_cones_});
}

int Marcher::band_rows(int width, int height) {
    const std::size_t row_bytes = std::size_t(width) * sizeof(interop::RayState);
    const std::size_t rows = gl::query_limits().shader_storage_bytes / row_bytes;
    // Whole blocks of 8x8 pixels, so that bands cut no block that a whole picture would not.
    return int(std::min<std::size_t>(std::max<std::size_t>(rows / 8 * 8, 8), std::size_t(height)));
}

void Marcher::begin_frame(const interop::MarchView& view, const Tree& tree, const BrickPool& pool,
                          bool is_blended, const MixTextures& mix) {
    mix_ = mix;
    blended_ = is_blended;
    size_ = glm::ivec2(view.width, view.row_count);
    const auto pixels = std::size_t(size_.x) * std::size_t(size_.y);
    if (pixels > capacity_) {
        rays_ = gl::Buffer(pixels * sizeof(interop::RayState), "ray states");
        lists_ = gl::Buffer(pixels * 4 * sizeof(std::uint32_t), "ray lists");
        image_ = gl::Buffer(pixels * sizeof(std::uint32_t), "picture");
        capacity_ = pixels;
    }
    shadow_rays_ = view.shadow_rays;
    soft_shadows_ = view.is_soft != 0;
    shadow_cones_ = view.is_cones != 0;
    const std::size_t sum_bytes =
        capacity_ * (shadow_cones_ ? sizeof(interop::ShadowConeSum) : sizeof(interop::ShadowSum));
    if (soft_shadows_ && shadow_sums_.size_bytes() < sum_bytes)
        shadow_sums_ = gl::Buffer(sum_bytes, "sums of shadow rays");
    queries_.begin_frame(size_, tree.entry_count(), pool.slot_count());
    interop::MarchView ray_view = view;
    // The ends of shadow rays hold for one direction.
    if (options_.block_starts && view.casts_shadows != 0 && view.light_is_positional == 0 && !soft_shadows_) {
        const ShadowEnds ends = shadow_ends(view, tree, is_blended);
        shadow_ends_.write(0, ends.ends.data(), ends.ends.size() * sizeof(float));
        ray_view.shadow_across = ends.across;
        ray_view.shadow_across_offset = ends.across_offset;
        ray_view.shadow_down = ends.down;
        ray_view.shadow_down_offset = ends.down_offset;
        ray_view.has_shadow_ends = 1;
    }
    view_.write(0, &ray_view, sizeof(ray_view));
    block_starts_ = options_.block_starts ? block_starts(view, tree, is_blended) : all_block_starts(view);
    are_in_order_ = false;
    if (mix.mesh_nearest != 0) add_empty_blocks(view, block_starts_);
    if (starts_.size_bytes() < block_starts_.size() * sizeof(interop::BlockStart))
        starts_ = gl::Buffer(capacity_ * sizeof(interop::BlockStart), "block starts");
    image_.fill(0, pixels * sizeof(std::uint32_t), view.background_pixel);
    show_tree_ = view.shown == SHOW_LEVELS || view.shown == SHOW_BRICKS;
    begin_part(0, block_starts_.size());
}

void Marcher::begin_part(std::size_t first, std::size_t count) {
    if (count < block_starts_.size() && !are_in_order_) {
        const auto blocks = unsigned((size_.x + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE);
        std::sort(block_starts_.begin(), block_starts_.end(), [&](const auto& a, const auto& b) {
            return morton_number(a.block % blocks, a.block / blocks) <
                   morton_number(b.block % blocks, b.block / blocks);
        });
        are_in_order_ = true;
    }
    part_first_ = first;
    part_count_ = count;
    const std::span<const interop::BlockStart> part = std::span(block_starts_).subspan(first, count);
    first_rays_ = pixels_of(part, size_);
    if (!part.empty()) starts_.write(0, part.data(), part.size_bytes());
    first_pass_ = true;
    pauses_ = 0;
    waiting_primary_ = 0;
    waiting_shadow_ = 0;
}

std::uint32_t Marcher::pixels_behind_part() const {
    return pixels_of(std::span(block_starts_).subspan(part_first_ + part_count_), size_);
}

void Marcher::set_windows(const std::vector<interop::MarchWindow>& windows) {
    const glm::ivec4 count(int(windows.size()), 0, 0, 0);
    windows_.write(0, &count, sizeof(count));
    windows_.write(window_header_bytes, windows.data(), windows.size() * sizeof(interop::MarchWindow));
}

void Marcher::bind_mix() const {
    if (mix_.mesh_nearest != 0) {
        glBindTextureUnit(TEXTURE_MESH_NEAREST, mix_.mesh_nearest);
        glBindTextureUnit(TEXTURE_MESH_SURFACE, mix_.mesh_surface);
    }
    if (mix_.proxy_span != 0) {
        glBindTextureUnit(TEXTURE_PROXY_SPAN, mix_.proxy_span);
        glBindTextureUnit(TEXTURE_PROXY_FACES, mix_.proxy_faces);
    }
}

void Marcher::set_mix(const gl::Program& program) const {
    if (mix_.mesh_nearest != 0) {
        program.set("mesh_first_row", mix_.mesh_first_row);
        program.set("voxels_hidden", int(mix_.voxels_hidden));
        program.set("mesh_shadows", int(mix_.mesh_shadows));
        program.set("mesh_self_shadow_height", mix_.mesh_self_shadow_height);
    }
    if (mix_.proxy_span != 0) program.set("proxy_first_row", mix_.proxy_first_row);
}

PassResult Marcher::run_pass(Round round, const Tree& tree, const BrickPool& pool, PassKind kind) {
    queries_.begin_pass(kind != PassKind::patient);
    view_.bind_uniform(UBO_VIEW);
    if (windows_.id() != 0) windows_.bind_uniform(UBO_WINDOWS);
    rays_.bind_storage(SSBO_RAYS);
    lists_.bind_storage(SSBO_LISTS);
    if (soft_shadows_) shadow_sums_.bind_storage(SSBO_SHADOW_SUMS);
    image_.bind_storage(SSBO_PICTURE);
    starts_.bind_storage(SSBO_BLOCK_STARTS);
    glBindTextureUnit(TEXTURE_SHADOW_ENDS, shadow_ends_texture_.id());
    tree.bind_for_reading();
    pool.bind_for_reading();
    bind_mix();
    if (content_.bind) content_.bind();

    const std::uint32_t old_shadow = waiting_shadow_;
    // Shadow rays that waited go first: those which this pass starts are appended behind what still waits.
    if (old_shadow != 0) dispatch({program(RayKind::shadow, kind), true, old_shadow}, round, pool, kind);
    const std::uint32_t primary =
        first_pass_ ? std::uint32_t(part_count_ * PIXEL_BLOCK_SIDE * PIXEL_BLOCK_SIDE) : waiting_primary_;
    if (primary != 0) dispatch({program(RayKind::primary, kind), false, primary}, round, pool, kind);
    const bool began = first_pass_;
    first_pass_ = false;
    list_side_ ^= 1;

    QueryBuffer::Reports reports = queries_.read(round);
    const interop::MarchCounters& counters = reports.counters;
    PassResult result;
    result.queries = std::move(reports.queries);
    result.brick_stamps = std::move(reports.brick_stamps);
    result.bytes_read = reports.bytes_read;
    const bool waiting = counters.waiting_primary != 0 || counters.waiting_shadow != 0;
    const bool stalled = waiting && result.queries.empty() && counters.paused == 0 && primary == 0;
    pauses_ = counters.paused != 0 && result.queries.empty() ? pauses_ + 1 : 0;
    const int most = shadow_rays_ * (windows_.id() != 0 ? most_pauses_in_windows : most_pauses);
    if (stalled || pauses_ > most) {
        throw Error(Fault::internal, "ray-marcher", "a ray did not come to an end",
                    "this is a fault of Cairn: please report the scene and the view");
    }
    result.stood_in = counters.stood_in;
    result.launched = mix_.proxy_span != 0 ? counters.launched : began ? first_rays_ : 0;
    result.waiting_primary = waiting_primary_ = counters.waiting_primary;
    result.waiting_shadow = waiting_shadow_ = counters.waiting_shadow;
    return result;
}

void Marcher::dispatch(const Dispatch& work, Round round, const BrickPool& pool, PassKind kind) const {
    // Four lists of `capacity_` pixels: primary in and out, shadow in and out, changing sides each pass.
    auto list = [&](int rays, int side) { return unsigned(std::size_t(2 * rays + side) * capacity_); };
    const int of_kind = work.is_shadow ? 1 : 0;
    const gl::Program& program = work.program;
    program.set("ray_count", work.rays);
    program.set("first_pass", int(first_pass_));
    program.set("list_in", list(of_kind, list_side_));
    program.set("list_out", list(of_kind, list_side_ ^ 1));
    if (kind != PassKind::patient) program.set("stand_in", int(kind == PassKind::stand_in));
    program.set("shadow_list", list(1, list_side_ ^ 1));
    program.set("pass_number", round.number);
    queries_.set(program);
    program.set("pool_levels", pool.levels());
    set_mix(program);
    program.use();
    gl::dispatch_threads(work.rays, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

std::vector<std::uint8_t> Marcher::read_image() const {
    return image_.read_all<std::uint8_t>(std::size_t(size_.x) * std::size_t(size_.y) * 4);
}

}  // namespace cairn::renderer

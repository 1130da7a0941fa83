#include "renderer/march/marcher.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/bindings.h"
#include "shaders/interop/config.h"

namespace cairn::renderer {
namespace {

constexpr unsigned group_size = 64;
/// Passes in a row in which rays only pause: a ray crosses fewer than 8 cells for each voxel across the root
/// cube.
constexpr int most_pauses = (8 << MAX_RESOLUTION_BITS) / TURN_BUDGET + 1;
constexpr std::size_t query_header_bytes = sizeof(interop::MarchCounters);
constexpr std::size_t query_counts_offset = query_header_bytes + QUERY_CAPACITY * sizeof(std::uint32_t);

}  // namespace

Marcher::Marcher(const TreeShape& shape, bool has_color, const gl::ShaderSource& shaders)
    : shaders_(shaders),
      defines_(shape.defines(has_color)),
      view_(sizeof(interop::MarchView), "view"),
      queries_(query_counts_offset + QUERY_COUNTS * sizeof(std::uint32_t), "tile query buffer") {
    (void)primary_program(PassKind::patient);
    (void)shadow_program(PassKind::patient);
}

const gl::Program& Marcher::primary_program(PassKind kind) {
    const int progressive = kind == PassKind::patient ? 0 : 1;
    const int show_tree = show_tree_ ? 1 : 0;
    const int blended = blended_ ? 1 : 0;
    gl::Program& program = primary_[std::size_t(progressive + 2 * show_tree + 4 * blended)];
    if (program.id() == 0) {
        gl::Defines defines = defines_;
        defines.emplace_back("PROGRESSIVE", std::to_string(progressive));
        defines.emplace_back("BLENDED", std::to_string(blended));
        defines.emplace_back("SHOW_TREE", std::to_string(show_tree));
        program = gl::build_compute(shaders_, "march/primary.comp.glsl", defines);
    }
    return program;
}

const gl::Program& Marcher::shadow_program(PassKind kind) {
    const int progressive = kind == PassKind::patient ? 0 : 1;
    const int blended = blended_ ? 1 : 0;
    gl::Program& program = shadow_[std::size_t(progressive + 2 * blended)];
    if (program.id() == 0) {
        gl::Defines defines = defines_;
        defines.emplace_back("BLENDED", std::to_string(blended));
        defines.emplace_back("PROGRESSIVE", std::to_string(progressive));
        program = gl::build_compute(shaders_, "march/shadow.comp.glsl", defines);
    }
    return program;
}

int Marcher::band_rows(int width, int height) {
    const std::size_t row_bytes = std::size_t(width) * sizeof(interop::RayState);
    const std::size_t rows = gl::query_limits().shader_storage_bytes / row_bytes;
    // Whole blocks of 8x8 pixels, so that bands cut no block that a whole picture would not.
    return int(std::min<std::size_t>(std::max<std::size_t>(rows / 8 * 8, 8), std::size_t(height)));
}

void Marcher::begin_frame(const interop::MarchView& view, const Tree& tree, const BrickPool& pool) {
    size_ = glm::ivec2(view.size_shadow.x, view.band.y);
    const auto pixels = std::size_t(size_.x) * std::size_t(size_.y);
    if (pixels > capacity_) {
        rays_ = gl::Buffer(pixels * sizeof(interop::RayState), "ray states");
        lists_ = gl::Buffer(pixels * 4 * sizeof(std::uint32_t), "ray lists");
        image_ = gl::Buffer(pixels * sizeof(std::uint32_t), "picture");
        capacity_ = pixels;
    }
    query_bits_offset_ = std::uint32_t(pool.slot_count());
    entry_count_ = tree.entry_count();
    const std::size_t usage_words = query_bits_offset_ + (3 * std::size_t(tree.entry_count()) + 31) / 32;
    if (usage_.size_bytes() != usage_words * sizeof(std::uint32_t)) {
        usage_ = gl::Buffer(usage_words * sizeof(std::uint32_t), "brick usage");
        usage_.fill(0);
    }
    view_.write(0, &view, sizeof(view));
    first_pass_ = true;
    blended_ = view.band.w != 0;
    show_tree_ = view.band.z != SHOW_SURFACE;
    pauses_ = 0;
    waiting_primary_ = 0;
    waiting_shadow_ = 0;
}

PassResult Marcher::run_pass(std::uint32_t round, const Tree& tree, const BrickPool& pool, PassKind kind) {
    // Stand-ins are asked for by progressive passes alone.
    const std::size_t query_words =
        ((kind == PassKind::patient ? 2 : 3) * std::size_t(tree.entry_count()) + 31) / 32;
    usage_.fill(query_bits_offset_ * sizeof(std::uint32_t), query_words * sizeof(std::uint32_t), 0);
    queries_.fill(0, query_header_bytes, 0);
    if (kind != PassKind::patient)
        queries_.fill(query_counts_offset, QUERY_COUNTS * sizeof(std::uint32_t), 0);
    view_.bind_uniform(UBO_VIEW);
    rays_.bind_storage(SSBO_RAYS);
    lists_.bind_storage(SSBO_LISTS);
    queries_.bind_storage(SSBO_QUERIES);
    usage_.bind_storage(SSBO_USAGE);
    image_.bind_storage(SSBO_IMAGE);
    tree.bind_for_reading();
    pool.bind_for_reading();

    const std::uint32_t old_shadow = waiting_shadow_;
    const glm::ivec2 blocks = (size_ + 7) / 8;
    // Shadow rays that waited go first: those which this pass starts are appended behind what still waits.
    if (old_shadow != 0) run({shadow_program(kind), true, old_shadow}, round, pool, kind);
    const std::uint32_t primary = first_pass_ ? std::uint32_t(blocks.x * blocks.y) * 64U : waiting_primary_;
    if (primary != 0) run({primary_program(kind), false, primary}, round, pool, kind);
    first_pass_ = false;
    list_side_ ^= 1;

    const interop::MarchCounters counters = read_counters();
    const bool waiting = counters.waiting_primary != 0 || counters.waiting_shadow != 0;
    const bool stalled = waiting && counters.queries == 0 && counters.paused == 0 && primary == 0;
    pauses_ = counters.paused != 0 && counters.queries == 0 ? pauses_ + 1 : 0;
    if (stalled || pauses_ > most_pauses) {
        throw Error(Fault::internal, "ray-marcher", "a ray did not come to an end",
                    "this is a fault of Cairn: please report the scene and the view");
    }
    PassResult result;
    result.stood_in = counters.stood_in;
    result.waiting_primary = waiting_primary_ = counters.waiting_primary;
    result.waiting_shadow = waiting_shadow_ = counters.waiting_shadow;
    result.queries = queries_.read_all<std::uint32_t>(std::min<std::size_t>(counters.queries, QUERY_CAPACITY),
                                                      query_header_bytes);
    if (kind != PassKind::patient)
        result.query_counts = queries_.read_all<std::uint32_t>(QUERY_COUNTS, query_counts_offset);
    result.brick_stamps = usage_.read_all<std::uint32_t>(std::size_t(pool.slot_count()));
    return result;
}

void Marcher::run(const Dispatch& dispatch, std::uint32_t round, const BrickPool& pool, PassKind kind) const {
    // Four lists of `capacity_` pixels: primary in and out, shadow in and out, changing sides each pass.
    auto list = [&](int rays, int side) { return unsigned(std::size_t(2 * rays + side) * capacity_); };
    const int of_kind = dispatch.is_shadow ? 1 : 0;
    const gl::Program& program = dispatch.program;
    program.set("ray_count", dispatch.rays);
    program.set("first_pass", int(first_pass_));
    program.set("list_in", list(of_kind, list_side_));
    program.set("list_out", list(of_kind, list_side_ ^ 1));
    if (kind != PassKind::patient) {
        program.set("stand_in", int(kind == PassKind::stand_in));
        program.set("entry_count", entry_count_);
    }
    program.set("shadow_list", list(1, list_side_ ^ 1));
    program.set("pass_number", round);
    program.set("usage_query_offset", query_bits_offset_);
    program.set("pool_levels", pool.levels());
    program.use();
    gl::dispatch_threads(dispatch.rays, group_size);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

interop::MarchCounters Marcher::read_counters() const {
    interop::MarchCounters counters{};
    queries_.read(0, &counters, sizeof(counters));
    return counters;
}

std::vector<std::uint8_t> Marcher::read_image() const {
    return image_.read_all<std::uint8_t>(std::size_t(size_.x) * std::size_t(size_.y) * 4);
}

}  // namespace cairn::renderer

#include "renderer/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/march/marcher.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/surface_content.h"
#include "shaders/interop/config.h"
#include "voxelizer/surface.h"

namespace cairn::renderer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

voxelizer::Surface flatten(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                           const TreeShape& shape) {
    const voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, shape.resolution());
    return voxelizer::build_surface(scene, snapshot, grid, {.attributes = true});
}

/// A camera that cannot be is a fault of the caller, and NaN in a shader is a picture that nobody can
/// explain.
void check(const View& view) {
    const Camera& camera = view.camera;
    auto fail = [](const std::string& what, const std::string& way_out) {
        throw Error(Fault::usage, "view", what, way_out);
    };
    if (view.width < 1 || view.height < 1 || view.width > 16384 || view.height > 16384) {
        fail(fmt::format("a picture of {} x {} pixels", view.width, view.height),
             "each side is between 1 and 16384");
    }
    if (!(camera.yfov > 0.0 && camera.yfov < 3.14159)) {
        fail("the field of view is not between 0 and 180 degrees", "45 degrees suit most scenes");
    }
    if (!(view.pixel_error > 0.0)) fail("the pixel error is not positive", "1 is the default");
    const glm::dvec3 forward = camera.target - camera.eye;
    const double length = glm::length(forward);
    if (!std::isfinite(length)) fail("the camera or its target is not finite", "use finite coordinates");
    if (length == 0.0) fail("the camera looks at where it stands", "move its target away from it");
    const double side = glm::length(glm::cross(forward / length, camera.up));
    if (!std::isfinite(side) || side < 1e-9) {
        fail("the camera's up direction is the one it looks along", "choose another up direction");
    }
    const glm::dvec3 light = view.light.positional ? view.light.position : view.light.towards;
    if (!std::isfinite(glm::length(light)) || (!view.light.positional && glm::length(light) == 0.0)) {
        fail("the light has no direction", "give it a finite one that is not zero");
    }
}

/// The view in voxels of the finest level, from the root cube's low corner.
interop::MarchView march_view(const View& view, const voxelizer::Grid& grid, int n) {
    auto place = [&](const glm::dvec3& world) { return glm::vec3((world - grid.origin) / grid.voxel_size); };
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double half_height = std::tan(0.5 * view.camera.yfov);
    const double half_width = half_height * view.width / view.height;

    // Levels are n apart: the nearest one, as in mip mapping, has voxels between 1 / sqrt(n) and sqrt(n)
    // pixels.
    const double cone = 2.0 * half_height / view.height * view.pixel_error * std::sqrt(double(n));

    // Far from the scene a float's step is many voxels: then rays start near the root cube, from the plane
    // that the eye moved forward lies in.
    const double side = grid.resolution.x;
    const glm::dvec3 eye = (view.camera.eye - grid.origin) / grid.voxel_size;
    const double distance = glm::dot(glm::dvec3(0.5 * side) - eye, forward);
    const double skipped = distance > 3.0 * side ? distance - 2.0 * side : 0.0;

    interop::MarchView out{};
    out.eye = glm::vec4(glm::vec3(eye + forward * skipped), float(cone));
    out.forward = glm::vec4(glm::vec3(forward), float(skipped));
    out.right = glm::vec4(glm::vec3(right * half_width), 0.0F);
    out.up = glm::vec4(glm::vec3(up * half_height), 0.0F);
    out.light = view.light.positional ? glm::vec4(place(view.light.position), 1.0F)
                                      : glm::vec4(glm::vec3(glm::normalize(view.light.towards)), 0.0F);
    out.light_color = glm::vec4(view.light.color, view.light.ambient);
    out.background = glm::vec4(view.background, 0.0F);
    out.size_shadow = glm::ivec4(view.width, view.height, view.shadow == Shadow::hard ? 1 : 0, 0);
    const auto finite = [](const glm::vec4& v) { return std::isfinite(glm::dot(v, glm::vec4(1.0F))); };
    if (!finite(out.eye) || !finite(out.forward) || !finite(out.light)) {
        throw Error(Fault::usage, "view", "the camera or the light is too far away for a float to tell",
                    "bring it nearer to the scene");
    }
    return out;
}

}  // namespace

/// In the order of the data's way: oracle and producer, pools, marcher.
struct Renderer::Parts {
    Parts(const TreeShape& tree_shape, std::unique_ptr<Content> shown, const TreeOptions& options,
          const gl::ShaderSource& shaders)
        : shape(tree_shape),
          content(std::move(shown)),
          pool(shape, content->has_color(), options.brick_pool_bytes),
          tree(shape, pool.slot_count(), options.node_pool_bytes, content->oracle().child_mask(Tile{})),
          marcher(shape, content->has_color(), shaders) {}

    void converge(const std::function<void(double)>& progress, double pixels, double pixels_before);
    void serve(std::vector<std::uint32_t> queries);
    void refine(Clock::time_point deadline);
    [[nodiscard]] PassResult march(PassKind kind);
    [[nodiscard]] bool serve_until(Clock::time_point deadline, const PassResult& pass);
    void subdivide(std::uint32_t entry);

    TreeShape shape;
    std::unique_ptr<Content> content;
    BrickPool pool;
    Tree tree;
    Marcher marcher;
    std::uint32_t round = 1;
    FrameStatistics statistics;
};

Renderer::Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options,
                   const gl::ShaderSource& shaders) {
    const TreeShape shape = make_tree_shape(options.n, options.m, options.max_resolution, options.mips);
    auto content = std::make_unique<SurfaceContent>(shape, flatten(scene, snapshot, shape), shaders);
    parts_ = std::make_unique<Parts>(shape, std::move(content), options, shaders);
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::Parts::subdivide(std::uint32_t entry) {
    if (!tree.wants_children(entry)) return;
    const std::optional<std::uint32_t> first = tree.add_children(entry);
    if (!first) return;
    ++statistics.nodes_subdivided;
    const Tile tile = tree.tile(entry);
    const glm::uvec2 mask = content->oracle().child_mask(tile);
    for (int child = 0; child < shape.child_count(); ++child) {
        if ((mask[child / 32] >> (child % 32) & 1U) == 0) continue;
        tree.set_child_mask(*first + std::uint32_t(child),
                            content->oracle().child_mask(child_of(tile, shape.n, child)));
    }
}

/// Answers the tile queries of a pass. Bricks come first, then the deepest nodes: whatever the pools' sizes,
/// the ray that is nearest to its data gets it, so every pass brings some ray forward and the frame ends.
void Renderer::Parts::serve(std::vector<std::uint32_t> queries) {
    auto level = [&](std::uint32_t query) { return tree.tile(query / 2).level; };
    std::sort(queries.begin(), queries.end(), [&](std::uint32_t a, std::uint32_t b) {
        const bool brick_a = a % 2 == QUERY_BRICK;
        const bool brick_b = b % 2 == QUERY_BRICK;
        if (brick_a != brick_b) return brick_a;
        if (level(a) != level(b)) return level(a) > level(b);
        return a < b;
    });
    std::vector<BrickRequest> requests;
    for (const std::uint32_t query : queries) {
        const std::uint32_t entry = query / 2;
        if (query % 2 == QUERY_CHILDREN) {
            subdivide(entry);
        } else if (tree.wants_brick(entry)) {
            if (const std::optional<int> slot = tree.add_brick(entry))
                requests.push_back({tree.tile(entry), *slot});
        }
    }
    content->producer().produce(requests, pool);
    statistics.bricks_produced += requests.size();
    statistics.tile_queries += queries.size();
    tree.upload();
}

PassResult Renderer::Parts::march(PassKind kind) {
    const auto start = Clock::now();
    PassResult pass = marcher.run_pass(round, tree, pool, kind);
    statistics.march_ms += milliseconds_since(start);
    ++statistics.passes;
    ++round;
    tree.begin_round(round, pass.brick_stamps);
    return pass;
}

/// Answers tile queries in the order of how many rays ask, the coarsest first among equals, until time is up;
/// one batch of them in any case. @return whether any was answered.
bool Renderer::Parts::serve_until(Clock::time_point deadline, const PassResult& pass) {
    /// Answered at once: the deadline is looked at between batches.
    constexpr std::size_t batch = 16;
    struct Question {
        std::uint32_t entry, rays;
        int level;
        bool for_children, to_stand_in;
    };
    std::vector<Question> questions;
    for (const std::uint32_t query : pass.queries) {
        const bool to_stand_in = query >= 2 * tree.entry_count();
        const std::uint32_t entry = to_stand_in ? query - 2 * tree.entry_count() : query / 2;
        questions.push_back({entry, pass.query_counts[query % QUERY_COUNTS], tree.tile(entry).level,
                             !to_stand_in && query % 2 == QUERY_CHILDREN, to_stand_in});
    }
    std::sort(questions.begin(), questions.end(), [](const Question& a, const Question& b) {
        return std::tuple(b.rays, a.level, a.entry) < std::tuple(a.rays, b.level, b.entry);
    });
    const std::uint64_t before = statistics.nodes_subdivided + statistics.bricks_produced;
    std::vector<BrickRequest> requests;
    for (std::size_t first = 0; first < questions.size(); first += batch) {
        for (std::size_t i = first; i < std::min(first + batch, questions.size()); ++i) {
            const Question& question = questions[i];
            if (question.for_children) {
                subdivide(question.entry);
            } else if (tree.wants_brick(question.entry)) {
                if (const std::optional<int> slot = tree.add_brick(question.entry, !question.to_stand_in))
                    requests.push_back({tree.tile(question.entry), *slot});
            }
        }
        content->producer().produce(requests, pool);
        glFinish();
        statistics.bricks_produced += requests.size();
        requests.clear();
        if (Clock::now() > deadline) break;
    }
    statistics.tile_queries += questions.size();
    tree.upload();
    return statistics.nodes_subdivided + statistics.bricks_produced > before;
}

/// Passes and production in turn until nothing is missing or time is up; then what is missing is stood in
/// for.
void Renderer::Parts::refine(Clock::time_point deadline) {
    for (;;) {
        const PassResult pass = march(PassKind::progressive);
        const auto start = Clock::now();
        const bool answered = serve_until(deadline, pass);
        statistics.produce_ms += milliseconds_since(start);
        if (pass.done()) return;
        if (Clock::now() > deadline || (!answered && !pass.queries.empty())) break;
    }
    for (bool done = false; !done;) {
        const PassResult pass = march(PassKind::stand_in);
        statistics.converged = statistics.converged && pass.stood_in == 0;
        // What only these rays have asked for, as shadow rays may, brings the next frame forward.
        (void)serve_until(deadline, pass);
        done = pass.done();
    }
}

/// Passes of rays and what they ask for, in turn, until nothing is missing.
void Renderer::Parts::converge(const std::function<void(double)>& progress, double pixels,
                               double pixels_before) {
    for (;;) {
        const PassResult pass = march(PassKind::patient);
        if (pass.done()) return;
        const auto start = Clock::now();
        serve(pass.queries);
        statistics.produce_ms += milliseconds_since(start);
        const double waiting = pass.waiting_primary + 0.5 * pass.waiting_shadow;
        const double band = double(marcher.band_pixels());
        if (progress) progress((pixels_before + band - waiting) / pixels);
    }
}

Image Renderer::march(const View& view, Rows rows, const std::function<void(int)>& march_band) {
    check(view);
    if (rows.first < 0 || rows.count < 1 || rows.count > view.height - rows.first) {
        throw Error(
            Fault::usage, "view",
            fmt::format("{} rows from row {} of a picture of {}", rows.count, rows.first, view.height),
            "ask for rows that the picture has");
    }
    Parts& parts = *parts_;
    const bool blended = view.level_of_detail == LevelOfDetail::blended;
    if (blended && parts.shape.mips == 0) {
        throw Error(Fault::usage, "view", "levels of detail cannot be blended without mip levels",
                    "make the renderer with TreeOptions::mips");
    }
    const auto start = Clock::now();
    const Tree::Counters before = parts.tree.counters();
    parts.statistics = FrameStatistics{};
    FrameStatistics& statistics = parts.statistics;

    interop::MarchView marched = march_view(view, parts.content->grid(), parts.shape.n);
    marched.surface_color = glm::vec4(parts.content->uniform_color(), 1.0F);
    const int band_rows = Marcher::band_rows(view.width, view.height);
    Image image{view.width, rows.count, {}};
    const int end = rows.first + rows.count;
    for (int row = rows.first; row < end; row += band_rows) {
        marched.band = glm::ivec4(row, std::min(band_rows, end - row), int(view.show), blended ? 1 : 0);
        parts.marcher.begin_frame(marched, parts.tree, parts.pool);
        march_band(row);
        std::vector<std::uint8_t> band = parts.marcher.read_image();
        if (image.rgba.empty()) {
            image.rgba = std::move(band);
        } else {
            image.rgba.insert(image.rgba.end(), band.begin(), band.end());
        }
    }

    statistics.milliseconds = milliseconds_since(start);
    statistics.bricks_evicted = parts.tree.counters().bricks_evicted - before.bricks_evicted;
    statistics.nodes_evicted = parts.tree.counters().nodes_evicted - before.nodes_evicted;
    statistics.bricks_resident = std::uint64_t(parts.tree.bricks_resident());
    statistics.brick_slots = std::uint64_t(parts.pool.slot_count());
    statistics.node_pool_bytes = parts.tree.size_bytes();
    statistics.brick_pool_bytes = parts.pool.size_bytes();
    return image;
}

Image Renderer::render(const View& view, const std::function<void(double)>& progress) {
    parts_->tree.keep_since(0);
    return march(view, {0, view.height}, [&](int row) {
        parts_->converge(progress, double(view.width) * view.height, double(view.width) * row);
    });
}

Image Renderer::render_rows(const View& view, Rows rows) {
    parts_->tree.keep_since(0);
    return march(view, rows, [&](int) { parts_->converge({}, 0.0, 0.0); });
}

Image Renderer::render_within(const View& view, double budget_ms) {
    return render_rows_within(view, {0, view.height}, budget_ms);
}

Image Renderer::render_rows_within(const View& view, Rows rows, double budget_ms) {
    constexpr double a_day = 86.4e6;
    if (!(budget_ms >= 0.0))
        throw Error(Fault::usage, "frame budget", "it is negative or not a number", "give it milliseconds");
    const auto deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(
                           std::chrono::duration<double, std::milli>(std::min(budget_ms, a_day)));
    parts_->tree.keep_since(parts_->round);
    return march(view, rows, [&](int) { parts_->refine(deadline); });
}

const FrameStatistics& Renderer::statistics() const {
    return parts_->statistics;
}

}  // namespace cairn::renderer

#include "renderer/renderer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <tuple>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/kept_picture.h"
#include "renderer/march/marcher.h"
#include "renderer/march/transfer_table.h"
#include "renderer/march/windows.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/batch_pace.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/surface_content.h"
#include "renderer/produce/volume_content.h"
#include "shaders/interop/config.h"
#include "voxelizer/surface.h"

namespace cairn::renderer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}
double milliseconds_since(Clock::time_point start) {
    return milliseconds(Clock::now() - start);
}

Clock::time_point deadline_in(double budget_ms) {
    constexpr double a_day = 86.4e6;
    if (!(budget_ms >= 0.0))
        throw Error(Fault::usage, "frame budget", "it is negative or not a number", "give it milliseconds");
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double, std::milli>(std::min(budget_ms, a_day)));
}

/// A tile query of a frame that must not take long.
struct Question {
    std::uint32_t entry, rays;
    int level;
    bool for_children, to_stand_in;
};

/// Asked for by most rays first, the coarsest first among equals.
std::vector<Question> by_urgency(const PassResult& pass, const Tree& tree) {
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
    return questions;
}

/// Frames of the same rows of the same view, one after the other.
struct Refined {
    View view;
    Rows rows;
    std::uint32_t since = 0;  ///< round in which they began; what they used is kept
    /// When the pools had filled: tiles that were stood in for. What stood in at first is kept too; while a
    /// new start leaves fewer missing, there is another.
    std::uint32_t stood_in = 0xFFFFFFFFU;
};

/// The last view, of which prefetch_finer() produces more than it shows.
struct Ahead {
    View view;
    std::uint32_t since = 1;  ///< round in which it was first rendered
    int bands_done = 0;
    bool done = true;
};
constexpr int ahead_pixels = 4096;  // of a band: a pass through it takes some milliseconds
constexpr int ahead_stride = 2;     // at most: pixels a ray

/// The same rays at fewer pixels: each sees the levels that it would see in the whole picture.
View thinned_by(const View& view, int stride) {
    View thin = view;
    thin.width = (view.width + stride - 1) / stride;
    thin.height = (view.height + stride - 1) / stride;
    thin.pixel_error = view.pixel_error * thin.height / view.height;
    return thin;
}

/// So few that they can be marched at once.
View thinned(const View& view) {
    int stride = 4;
    View thin = thinned_by(view, stride);
    while (view.width > 1 && Marcher::band_rows(thin.width, thin.height) < thin.height)
        thin = thinned_by(view, stride *= 2);
    return thin;
}

/// One level finer. A brick of that level is hit by some ray.
View finer(const View& view, const TreeShape& shape) {
    View fine = view;
    fine.pixel_error = view.pixel_error / shape.n;
    return thinned_by(fine, std::clamp(int(shape.m * fine.pixel_error), 1, ahead_stride));
}

/// Bands from the middle of a picture outwards: who comes nearer sees that for longest. @return false behind
/// the last one.
bool band_from_middle(const View& view, int number, Rows& rows) {
    const int count = std::max(ahead_pixels / view.width / PIXEL_BLOCK_SIDE, 1) * PIXEL_BLOCK_SIDE;
    const int bands = (view.height + count - 1) / count;
    if (number >= bands) return false;
    const int middle = bands / 2;
    const int band = number % 2 == 0 ? middle + number / 2 : middle - (number + 1) / 2;
    rows = {band * count, std::min(count, view.height - band * count)};
    return true;
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
    if (!(view.shadow_pixel_error >= 1.0 / 64.0 && view.shadow_pixel_error <= 64.0))
        fail("the pixel error of shadows is not between 1/64 and 64", "1 is the default");
    const glm::dvec3 forward = camera.target - camera.eye;
    const double length = glm::length(forward);
    if (!std::isfinite(length)) fail("the camera or its target is not finite", "use finite coordinates");
    if (length == 0.0) fail("the camera looks at where it stands", "move its target away from it");
    const double side = glm::length(glm::cross(forward / length, camera.up));
    if (!std::isfinite(side) || side < 1e-9) {
        fail("the camera's up direction is the one it looks along", "choose another up direction");
    }
    if (view.shadow_rays < 1 || view.shadow_rays > MAX_SHADOW_RAYS) {
        fail(fmt::format("{} shadow rays a pixel", view.shadow_rays),
             fmt::format("choose 1 to {}", MAX_SHADOW_RAYS));
    }
    if (!(view.light.radius >= 0.0) || !std::isfinite(view.light.radius))
        fail("the light's radius is negative or not finite", "0 is a point");
    if (!(view.light.angle >= 0.0 && view.light.angle < 1.5707))
        fail("the light's angle is not between 0 and 90 degrees", "the sun's is 0.27 degrees");
    if (!std::isfinite(glm::length(view.light.half_u)) || !std::isfinite(glm::length(view.light.half_v)))
        fail("the light's half axes are not finite", "use finite ones");
    const glm::dvec3 light = view.light.positional ? view.light.position : view.light.towards;
    if (!std::isfinite(glm::length(light)) || (!view.light.positional && glm::length(light) == 0.0)) {
        fail("the light has no direction", "give it a finite one that is not zero");
    }
}

/// A pixel that shows nothing else, as write_pixel() in shade.glsl would encode it.
std::uint32_t background_pixel(const glm::vec3& linear) {
    std::uint32_t pixel = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const double c = std::clamp(double(linear[channel]), 0.0, 1.0);
        const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
        pixel |= std::uint32_t(std::lround(255.0 * encoded)) << (8 * channel);
    }
    return pixel;
}

Image background_image(const View& view, Rows rows) {
    Image image{view.width, rows.count, {}};
    const std::uint32_t pixel = background_pixel(view.background);
    image.rgba.resize(std::size_t(view.width) * std::size_t(rows.count) * 4);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = std::uint8_t(pixel >> (8 * (i % 4)) & 0xFFU);
    return image;
}

void check_anchor(const std::optional<Tile>& anchor, const TreeShape& shape) {
    if (!anchor) return;
    const bool has_level = anchor->level >= 0 && anchor->level <= shape.max_level;
    const std::int64_t across = std::int64_t(1) << (has_level ? shape.n_shift() * anchor->level : 0);
    if (!has_level || glm::any(glm::lessThan(anchor->position, glm::i64vec3(0))) ||
        glm::any(glm::greaterThanEqual(anchor->position, glm::i64vec3(across)))) {
        throw Error(Fault::usage, "view", "the tree has no tile where the camera is anchored",
                    fmt::format("its levels are 0 to {}", shape.max_level));
    }
}

/// Where a point of the view is in the tree. Unanchored ones are told from the root cube.
Place place_of(const View& view, const glm::dvec3& point, const voxelizer::Grid& grid) {
    if (view.anchor) return {*view.anchor, point};
    return {Tile{}, (point - grid.origin) / (grid.voxel_size * grid.resolution.x)};
}

/// The view without its anchor, for trees whose depth doubles can tell.
View in_world(const View& view, const voxelizer::Grid& grid, const TreeShape& shape) {
    if (!view.anchor) return view;
    View out = view;
    const double side = grid.voxel_size * grid.resolution.x;
    const double across = std::ldexp(1.0, shape.n_shift() * view.anchor->level);
    auto to_world = [&](const glm::dvec3& place) {
        return grid.origin + (glm::dvec3(view.anchor->position) + place) * (side / across);
    };
    out.camera.eye = to_world(view.camera.eye);
    out.camera.target = to_world(view.camera.target);
    out.light.position = to_world(view.light.position);
    out.light.radius *= side / across;
    out.light.half_u *= side / across;
    out.light.half_v *= side / across;
    out.anchor.reset();
    return out;
}

/// Does the view ask for shadows of more than the light's middle?
bool is_soft(const View& view) {
    const Light& light = view.light;
    if (view.shadow != Shadow::hard || view.shadow_rays == 1) return false;
    if (!light.positional) return light.angle > 0.0;
    if (light.shape == LightShape::sphere) return light.radius > 0.0;
    return light.half_u != glm::dvec3(0.0) || light.half_v != glm::dvec3(0.0);
}

static_assert(int(LightShape::sphere) == LIGHT_CONE && int(LightShape::rectangle) == LIGHT_RECTANGLE &&
              int(LightShape::disk) == LIGHT_DISK);

/// @param voxel_size  of the voxels that the view is told in, in units of its light.
void set_area_light(interop::MarchView& out, const View& view, double voxel_size) {
    const Light& light = view.light;
    const double lost = 2.0 * std::pow(std::sin(0.5 * light.angle), 2.0);
    out.light_u = glm::vec4(glm::vec3(light.half_u / voxel_size), float(light.radius / voxel_size));
    out.light_v = glm::vec4(glm::vec3(light.half_v / voxel_size), float(lost));
    const LightShape shape = light.positional ? light.shape : LightShape::sphere;
    out.area_light = glm::ivec4(is_soft(view) ? view.shadow_rays : 1, int(shape), 0, 0);
}

/// What of a view is told in voxels: of the finest level, from the root cube's low corner; or of the coarsest
/// window, from its own.
struct Placed {
    glm::dvec3 eye{0.0};
    glm::dvec3 light{0.0};   ///< when positional
    glm::dvec3 centre{0.0};  ///< of the root cube
    double side = 0.0;       ///< of the root cube
    double voxel = 1.0;      ///< in the units that the view's lengths are told in
};

Placed in_voxels(const View& view, const voxelizer::Grid& grid) {
    auto place = [&](const glm::dvec3& world) { return (world - grid.origin) / grid.voxel_size; };
    const double side = grid.resolution.x;
    return {place(view.camera.eye), place(view.light.position), glm::dvec3(0.5 * side), side,
            grid.voxel_size};
}

Placed in_window(const View& view, const voxelizer::Grid& grid, const TreeShape& shape,
                 const Window& window) {
    auto place = [&](const Place& point) { return place_in(window, shape, point); };
    const glm::dvec3 low = place({Tile{}, glm::dvec3(0.0)});
    const glm::dvec3 high = place({Tile{}, glm::dvec3(1.0)});
    const double unit = view.anchor ? std::ldexp(1.0, -shape.n_shift() * view.anchor->level)
                                    : 1.0 / (grid.voxel_size * grid.resolution.x);
    return {place(place_of(view, view.camera.eye, grid)), place(place_of(view, view.light.position, grid)),
            0.5 * (low + high), high.x - low.x, 1.0 / ((high.x - low.x) * unit)};
}

interop::MarchView march_view(const View& view, const Placed& placed, int n) {
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
    const glm::dvec3& eye = placed.eye;
    const double distance = glm::dot(placed.centre - eye, forward);
    const double skipped = distance > 3.0 * placed.side ? distance - 2.0 * placed.side : 0.0;

    interop::MarchView out{};
    out.eye = glm::vec4(glm::vec3(eye + forward * skipped), float(cone));
    out.forward = glm::vec4(glm::vec3(forward), float(skipped));
    out.right = glm::vec4(glm::vec3(right * half_width), 0.0F);
    out.up = glm::vec4(glm::vec3(up * half_height), 0.0F);
    out.light = view.light.positional ? glm::vec4(glm::vec3(placed.light), 1.0F)
                                      : glm::vec4(glm::vec3(glm::normalize(view.light.towards)), 0.0F);
    out.light_color = glm::vec4(view.light.color, view.light.ambient);
    out.background = glm::vec4(view.background, float(view.shadow_pixel_error));
    set_area_light(out, view, placed.voxel);
    out.size_shadow = glm::ivec4(view.width, view.height, view.shadow == Shadow::hard ? 1 : 0, 0);
    const auto finite = [](const glm::vec4& v) { return std::isfinite(glm::dot(v, glm::vec4(1.0F))); };
    if (!finite(out.eye) || !finite(out.forward) || !finite(out.light)) {
        throw Error(Fault::usage, "view", "the camera or the light is too far away for a float to tell",
                    "bring it nearer to the scene");
    }
    return out;
}

MarchKind with_content(MarchKind kind, const Content& content) {
    if (content.has_constant()) kind.defines.emplace_back("HAS_CONSTANT", "1");
    if (content.has_low_frequency()) kind.defines.emplace_back("HAS_FINAL", "1");
    return kind;
}

}  // namespace

/// In the order of the data's way: oracle and producer, pools, marcher.
struct Renderer::Parts {
    Parts(const TreeShape& tree_shape, std::unique_ptr<Content> shown, const TreeOptions& options,
          const gl::ShaderSource& shaders, MarchKind kind = {})
        : shape(tree_shape),
          content(std::move(shown)),
          pool(shape, content->channels(), options.brick_pool_bytes),
          tree(shape, pool.slot_count(), options.node_pool_bytes, content->oracle().child_mask(Tile{}),
               content->has_constant()),
          marcher(shape, content->has_color(),
                  {options.traversal, options.block_starts, options.query_capacity, options.tile_queries},
                  shaders, with_content(std::move(kind), *content)),
          tile_queries(options.tile_queries) {
        if (options.mips && !content->fills_mips()) {
            throw Error(Fault::usage, "tree", "the bricks of this content have no mip levels",
                        "leave the mips and blended levels of detail to surfaces");
        }
        if (options.brick_cache_bytes == 0) return;
        if (content->has_low_frequency()) {
            throw Error(Fault::usage, "brick cache", "it cannot tell which tiles of this content are final",
                        "leave it out");
        }
        cache.emplace(pool, options.brick_cache_bytes);
        tree.record_evictions(true);
    }

    [[nodiscard]] interop::MarchView march_view_of(const View& view);
    void find_tiles_asked_for(const std::vector<std::uint32_t>& entries);
    void converge(const std::function<void(double)>& progress, double pixels, double pixels_before);
    void serve(std::vector<std::uint32_t> queries);
    void refine(Clock::time_point deadline);
    void require_lists() const;
    void look_ahead(Clock::time_point deadline);
    [[nodiscard]] PassResult march(PassKind kind);
    struct Serve {
        bool in_any_case = false;  ///< the first batch, though there be no time
        bool ahead = false;        ///< nothing loses its place which the last frame used
    };
    [[nodiscard]] bool serve_until(Clock::time_point deadline, const PassResult& pass, Serve how);
    void subdivide(std::uint32_t entry);
    [[nodiscard]] int draw_mix(const interop::MarchView& view, int row);
    void give_children(std::uint32_t entry);
    void request(std::uint32_t entry, bool may_stay);
    void restore_requests();
    void produce_requests();
    /// Where only a tile's own brick tells whether anything finer would show, that comes first.
    [[nodiscard]] bool wants_brick_first(std::uint32_t entry) const {
        return content->has_low_frequency() && tree.wants_children(entry) && !tree.was_produced(entry);
    }
    void keep_nothing();
    void keep_what_was_used_for(const View& view, Rows rows);
    [[nodiscard]] bool is_empty() const;
    [[nodiscard]] bool blends(const View& view) const;
    void note_caches(const FrameStatistics& before);
    [[nodiscard]] FrameStatistics totals() const;

    TreeShape shape;
    std::unique_ptr<Content> content;
    BrickPool pool;
    Tree tree;
    Marcher marcher;
    std::vector<Window> windows;  ///< of the frame; none where the shape has none
    std::vector<interop::MarchWindow> marched_windows;
    Mix mix;
    MarchMix drawn;  ///< of `mix`, around the band that is marched
    std::optional<BrickCache> cache;
    BatchPace batches;
    KeptPicture picture;
    TileQueries tile_queries = TileQueries::list;
    Refined refined;
    Ahead ahead;
    std::uint64_t prefetched = 0;   ///< since the last frame
    std::uint32_t frame_round = 1;  ///< what was used since is the last frame's
    std::uint32_t round = 1;
    std::vector<BrickRequest> requests;  // that wait to be produced together
    std::vector<std::uint32_t> requested_entries;
    FrameStatistics statistics;
};

Renderer::Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options,
                   const gl::ShaderSource& shaders) {
    const TreeShape shape = tree_shape_of(options);
    if (shape.has_windows()) {
        throw Error(Fault::usage, "tree", "a surface has no voxels as fine as its finest level",
                    fmt::format("give it at most 2^{} voxels across", MAX_RESOLUTION_BITS));
    }
    auto content = std::make_unique<SurfaceContent>(shape, flatten(scene, snapshot, shape), shaders);
    parts_ = std::make_unique<Parts>(shape, std::move(content), options, shaders);
}

Renderer::Renderer(std::unique_ptr<Content> content, const TreeOptions& options,
                   const gl::ShaderSource& shaders)
    : parts_(std::make_unique<Parts>(tree_shape_of(options), std::move(content), options, shaders)) {}

TreeShape tree_shape_of(const TreeOptions& options) {
    if (!options.max_level)
        return make_tree_shape(options.n, options.m, options.max_resolution, options.mips);
    if (options.mips) {
        throw Error(Fault::usage, "tree", "bricks of a tree of any depth have no mip levels",
                    "leave the mips and blended levels of detail to surfaces");
    }
    return make_deep_tree_shape(options.n, options.m, *options.max_level);
}

Renderer::Renderer(const scenes::Volume& volume, const TransferFunction& transfer, const TreeOptions& options,
                   const VolumeOptions& volume_options, const gl::ShaderSource& shaders)
    : Renderer(std::make_shared<DenseField>(volume, options.n), transfer, options, volume_options, shaders) {}

Renderer::Renderer(std::shared_ptr<const Field> field, const TransferFunction& transfer,
                   const TreeOptions& options, const VolumeOptions& volume_options,
                   const gl::ShaderSource& shaders) {
    const VolumeShape shape = make_volume_shape(field->frame(), options.n, options.m, options.max_resolution);
    auto content = std::make_unique<VolumeContent>(shape, std::move(field), transfer.visible());
    auto table = std::make_shared<TransferTable>(transfer, volume_options, content->grid().voxel_size);
    MarchKind kind{"march/volume.comp.glsl",
                   "march/volume_shadow.comp.glsl",
                   {{"VOLUME_STEPS", std::to_string(volume_options.steps_per_voxel)}},
                   [table] { table->bind(); },
                   false};
    parts_ = std::make_unique<Parts>(shape.tree, std::move(content), options, shaders, std::move(kind));
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_mix(const Mix& mix) {
    parts_->mix = mix;
    parts_->picture.forget();
}

/// Draws what the rays of a row meet beside voxels. Returns the row behind the last that has been drawn.
int Renderer::Parts::draw_mix(const interop::MarchView& view, int row) {
    const MarchSpace space{content->grid().origin, content->grid().voxel_size};
    int end = view.size_shadow.y;
    drawn = MarchMix{};
    if (mix.meshes != nullptr) {
        const MeshSurface mesh = mix.meshes->draw_surface(view, space, row);
        drawn.mesh_nearest = mesh.nearest;
        drawn.mesh_surface = mesh.surface;
        drawn.mesh_first_row = mesh.first_row;
        drawn.mesh_shadows = mix.mesh_shadows;
        drawn.voxels_hidden = mix.voxels_hidden;
        drawn.mesh_own_height = mix.meshes_are_voxelized ? MESH_OWN_HEIGHT : 0.0F;
        end = std::min(end, mesh.first_row + mesh.rows);
    }
    if (mix.proxy != nullptr) {
        const MeshSpan span = mix.proxy->draw_span(view, space, row);
        drawn.proxy_span = span.span;
        drawn.proxy_faces = span.faces;
        drawn.proxy_first_row = span.first_row;
        end = std::min(end, span.first_row + span.rows);
    }
    return end;
}

void Renderer::Parts::subdivide(std::uint32_t entry) {
    if (tree.wants_children(entry)) give_children(entry);
}

void Renderer::Parts::give_children(std::uint32_t entry) {
    const std::optional<std::uint32_t> first = tree.add_children(entry);
    if (!first) return;
    ++statistics.nodes_subdivided;
    const Tile tile = tree.tile(entry);
    const glm::uvec2 mask = content->oracle().child_mask(tile);
    for (int child = 0; child < shape.child_count(); ++child) {
        if (!may_hold(mask, shape.n, child)) continue;
        const Tile child_tile = child_of(tile, shape.n, child);
        const std::uint32_t child_entry = *first + std::uint32_t(child);
        if (shape.n == 8 && content->oracle().is_empty(child_tile)) {
            tree.set_constant(child_entry, glm::u8vec4(0));
            tree.set_final(child_entry);
        } else {
            tree.set_child_mask(child_entry, content->oracle().child_mask(child_tile));
        }
    }
}

/// Places the windows too, where there are any.
interop::MarchView Renderer::Parts::march_view_of(const View& view) {
    const voxelizer::Grid& grid = content->grid();
    const glm::vec4 surface_color(content->uniform_color(), 1.0F);
    if (!shape.has_windows()) {
        const View unanchored = in_world(view, grid, shape);
        interop::MarchView marched = march_view(unanchored, in_voxels(unanchored, grid), shape.n);
        marched.surface_color = surface_color;
        return marched;
    }
    const Place eye = place_of(view, view.camera.eye, grid);
    const Place light = place_of(view, view.light.position, grid);
    windows = windows_around(shape, eye);
    drop_empty(windows, shape, content->oracle());
    interop::MarchView marched = march_view(view, in_window(view, grid, shape, windows.back()), shape.n);
    marched.surface_color = surface_color;
    marched_windows =
        march_windows(windows, shape, eye, view.light.positional ? &light : nullptr, view.light.towards);
    marched_windows.back().eye = marched.eye;  // nearer to the scene, where the eye is far from it
    return marched;
}

/// Rays that miss a tile of a window ask for children of its nearest ancestor: brings the tile itself, so
/// that a deep view does not take a pass for each level.
void Renderer::Parts::find_tiles_asked_for(const std::vector<std::uint32_t>& entries) {
    if (!shape.has_windows() || entries.empty()) return;
    std::unordered_set<std::uint32_t> asked;
    auto add_children_of = [&](std::uint32_t entry) {
        const std::uint32_t first = tree.node(entry).children;
        for (int child = 0; first != 0 && child < shape.child_count(); ++child)
            asked.insert(first + std::uint32_t(child));
    };
    for (const std::uint32_t entry : entries)
        add_children_of(entry);
    find_tiles(windows, tree, marched_windows, [&](std::uint32_t entry) {
        if (!asked.contains(entry)) return;
        give_children(entry);
        add_children_of(entry);
    });
}

/// Gives the tile a slot, if there is one, to be filled by produce_requests().
void Renderer::Parts::request(std::uint32_t entry, bool may_stay) {
    if (!tree.wants_brick(entry)) return;
    const std::optional<int> slot = tree.add_brick(entry, may_stay);
    if (!slot) return;
    requests.push_back({tree.tile(entry), *slot});
    requested_entries.push_back(entry);
}

/// Answers from main memory what is there.
void Renderer::Parts::restore_requests() {
    cache->store(tree.take_evicted());
    std::vector<BrickRequest> unknown;
    std::vector<std::uint32_t> unknown_entries;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (cache->restore(requests[i].tile, requests[i].slot)) continue;
        unknown.push_back(requests[i]);
        unknown_entries.push_back(requested_entries[i]);
    }
    requests = std::move(unknown);
    requested_entries = std::move(unknown_entries);
}

/// Puts bricks in the slots that they were given: from main memory where they are there, else produced.
void Renderer::Parts::produce_requests() {
    if (cache) restore_requests();
    const std::vector<Produced> found = content->producer().produce(requests, pool);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::uint32_t entry = requested_entries[i];
        if (content->has_low_frequency()) tree.set_produced(entry);
        if (found[i].low_frequency) tree.set_final(entry);
        if (!found[i].constant) continue;
        tree.set_constant(entry, found[i].mean);
        ++statistics.constant_tiles;
    }
    statistics.bricks_produced += requests.size();
    requests.clear();
    requested_entries.clear();
}

/// Answers the tile queries of a pass. Bricks come first, then the deepest nodes: whatever the pools' sizes,
/// the ray that is nearest to its data gets it, so every pass brings some ray forward and the frame ends.
void Renderer::Parts::serve(std::vector<std::uint32_t> queries) {
    const auto start = Clock::now();
    auto level = [&](std::uint32_t query) { return tree.tile(query / 2).level; };
    std::sort(queries.begin(), queries.end(), [&](std::uint32_t a, std::uint32_t b) {
        const bool brick_a = a % 2 == QUERY_BRICK;
        const bool brick_b = b % 2 == QUERY_BRICK;
        if (brick_a != brick_b) return brick_a;
        if (level(a) != level(b)) return level(a) > level(b);
        return a < b;
    });
    std::vector<std::uint32_t> parents;
    for (const std::uint32_t query : queries) {
        const std::uint32_t entry = query / 2;
        if (query % 2 == QUERY_CHILDREN && !wants_brick_first(entry)) {
            subdivide(entry);
            parents.push_back(entry);
        } else {
            request(entry, true);
        }
    }
    find_tiles_asked_for(parents);
    const auto before_bricks = Clock::now();
    produce_requests();
    const auto after_bricks = Clock::now();
    statistics.tile_queries += queries.size();
    tree.upload();
    statistics.tree_ms += milliseconds_since(start) - milliseconds(after_bricks - before_bricks);
}

PassResult Renderer::Parts::march(PassKind kind) {
    const auto start = Clock::now();
    if (shape.has_windows()) {
        find_tiles(windows, tree, marched_windows);
        marcher.set_windows(marched_windows);
    }
    PassResult pass = marcher.run_pass(round, tree, pool, kind);
    statistics.march_ms += milliseconds_since(start);
    ++statistics.passes;
    statistics.rays_launched += pass.launched;
    statistics.query_bytes += pass.bytes_read;
    ++round;
    tree.begin_round(round, pass.brick_stamps);
    return pass;
}

/// Answers the most urgent tile queries until time is up, in batches that end soon after it.
/// @return whether any was answered.
bool Renderer::Parts::serve_until(Clock::time_point deadline, const PassResult& pass, Serve how) {
    const std::vector<Question> questions = by_urgency(pass, tree);
    statistics.tile_queries += questions.size();
    std::uint64_t all_answered = 0;
    std::vector<std::uint32_t> parents;
    auto next = questions.begin();
    for (bool first = how.in_any_case; next != questions.end(); first = false) {
        const auto start = Clock::now();
        if (start > deadline && !first) break;
        const std::size_t batch = batches.batch(milliseconds(deadline - start));
        const std::uint64_t nodes_before = statistics.nodes_subdivided;
        for (;
             next != questions.end() && requests.size() + statistics.nodes_subdivided - nodes_before < batch;
             ++next) {
            if (next->for_children && !wants_brick_first(next->entry)) {
                subdivide(next->entry);
                parents.push_back(next->entry);
            } else {
                request(next->entry, !next->to_stand_in && !how.ahead);
            }
        }
        find_tiles_asked_for(parents);
        parents.clear();
        const std::size_t answered = requests.size() + statistics.nodes_subdivided - nodes_before;
        produce_requests();
        glFinish();
        batches.learn(milliseconds_since(start), answered);
        all_answered += answered;
    }
    tree.upload();
    return all_answered > 0;
}

/// Passes and production in turn until nothing is missing or time is up; then what is missing is stood in
/// for.
void Renderer::Parts::refine(Clock::time_point deadline) {
    bool any_answered = false;
    auto serve_pass = [&](const PassResult& pass) {
        const auto start = Clock::now();
        const bool answered = serve_until(deadline, pass, {.in_any_case = !any_answered});
        statistics.produce_ms += milliseconds_since(start);
        any_answered = any_answered || answered;
        return answered;
    };
    for (;;) {
        const PassResult pass = march(PassKind::progressive);
        const bool answered = serve_pass(pass);
        if (pass.done()) return;
        if (Clock::now() > deadline || (!answered && !pass.queries.empty())) break;
    }
    std::uint32_t stood_in = 0;
    for (bool done = false; !done;) {
        const PassResult pass = march(PassKind::stand_in);
        stood_in += pass.stood_in;
        statistics.converged = statistics.converged && pass.stood_in == 0;
        // What only these rays have asked for, as shadow rays may, brings the next frame forward.
        (void)serve_pass(pass);
        done = pass.done();
    }
    if (any_answered || stood_in >= refined.stood_in) return;
    refined.since = 0;
    refined.stood_in = stood_in;
}

/// What stays from frame to frame, and what makes room, must be known in full.
void Renderer::Parts::require_lists() const {
    if (tile_queries == TileQueries::list) return;
    throw Error(Fault::usage, "tile queries", "blocks of pixels do not tell all that a frame used",
                "choose lists for frames within a budget and for prefetching");
}

/// Produces for the next band of the last view one level finer, until it is done or time is up. The first
/// answers come in any case, so that each call gets on.
void Renderer::Parts::look_ahead(Clock::time_point deadline) {
    const View fine = finer(ahead.view, shape);
    Rows rows;
    if (!band_from_middle(fine, ahead.bands_done, rows)) {
        ahead.done = true;
        return;
    }
    interop::MarchView marched = march_view_of(fine);
    marched.band = glm::ivec4(rows.first, rows.count, int(fine.show), int(background_pixel(fine.background)));
    tree.keep_since(ahead.since);
    marcher.begin_frame(marched, tree, pool, blends(ahead.view));
    for (;;) {
        const PassResult pass = march(PassKind::progressive);
        const bool answered = serve_until(deadline, pass, {.in_any_case = true, .ahead = true});
        if (pass.done()) {
            ++ahead.bands_done;
            return;
        }
        if (pass.queries.empty()) continue;  // rays paused
        ahead.done = !answered;              // there is no more room
        if (ahead.done || Clock::now() > deadline) return;
    }
}

/// A frame that has all the time may give up what a pass has used: no ray goes back.
void Renderer::Parts::keep_nothing() {
    frame_round = round;
    tree.keep_since(0);
}

/// What frames of these rows use is kept from the first of them on, so that they come to an end.
void Renderer::Parts::keep_what_was_used_for(const View& view, Rows rows) {
    if (!(view == refined.view && rows == refined.rows)) refined = {view, rows};
    if (refined.since == 0) refined.since = round;
    frame_round = refined.since;
    tree.keep_since(frame_round);
}

/// Nothing in the whole scene: known without a ray. (A tree of one level has no children to tell it.)
bool Renderer::Parts::is_empty() const {
    return shape.max_level > 0 && tree.node(0).child_mask == glm::uvec2(0);
}

/// @throws Error (Fault::usage) when the view asks for blended levels of detail and bricks have no mips.
bool Renderer::Parts::blends(const View& view) const {
    const bool is_blended = view.level_of_detail == LevelOfDetail::blended;
    if (is_blended && shape.mips == 0) {
        throw Error(Fault::usage, "view", "levels of detail cannot be blended without mip levels",
                    "make the renderer of a surface with TreeOptions::mips");
    }
    return is_blended;
}

/// Counters since the renderer was made.
FrameStatistics Renderer::Parts::totals() const {
    FrameStatistics total;
    total.bricks_evicted = tree.counters().bricks_evicted;
    total.nodes_evicted = tree.counters().nodes_evicted;
    total.bricks_relinked = tree.counters().bricks_relinked;
    total.bricks_cached = cache ? cache->counters().stored : 0;
    total.bricks_restored = cache ? cache->counters().restored : 0;
    return total;
}

void Renderer::Parts::note_caches(const FrameStatistics& before) {
    const FrameStatistics now = totals();
    statistics.bricks_evicted = now.bricks_evicted - before.bricks_evicted;
    statistics.nodes_evicted = now.nodes_evicted - before.nodes_evicted;
    statistics.bricks_relinked = now.bricks_relinked - before.bricks_relinked;
    statistics.bricks_cached = now.bricks_cached - before.bricks_cached;
    statistics.bricks_restored = now.bricks_restored - before.bricks_restored;
    statistics.bricks_prefetched = std::exchange(prefetched, 0);
    statistics.bricks_resident = std::uint64_t(tree.bricks_resident());
    statistics.bricks_used = std::uint64_t(tree.bricks_used_since(frame_round));
    statistics.brick_slots = std::uint64_t(pool.slot_count());
    statistics.node_pool_bytes = tree.size_bytes();
    statistics.brick_pool_bytes = pool.size_bytes();
    statistics.brick_cache_bytes = cache ? cache->size_bytes() : 0;
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

Image Renderer::march(const View& view, Rows rows, int shown, const std::function<void(int)>& march_band) {
    check(view);
    check_anchor(view.anchor, parts_->shape);
    if (rows.first < 0 || rows.count < 1 || rows.count > view.height - rows.first) {
        throw Error(
            Fault::usage, "view",
            fmt::format("{} rows from row {} of a picture of {}", rows.count, rows.first, view.height),
            "ask for rows that the picture has");
    }
    Parts& parts = *parts_;
    if (is_soft(view) && !parts.marcher.has_soft_shadows()) {
        throw Error(Fault::usage, "view", "soft shadows of a volume", "give it one shadow ray a pixel");
    }
    if (!(view == parts.ahead.view)) parts.ahead = {view, parts.round, 0, false};
    const bool is_blended = parts.blends(view);
    const auto start = Clock::now();
    const FrameStatistics before = parts.totals();
    parts.statistics = FrameStatistics{};
    FrameStatistics& statistics = parts.statistics;

    interop::MarchView marched = parts.march_view_of(view);
    const int band_rows = Marcher::band_rows(view.width, view.height);
    const bool shows_light = shown == SHOW_LIGHT;
    Image image;
    if (!shows_light) {
        image = parts.is_empty() && parts.mix.meshes == nullptr ? background_image(view, rows)
                                                                : parts.picture.rows(view, rows);
    }
    const std::uint32_t background =
        shows_light ? std::bit_cast<std::uint32_t>(float(SHOWN_NOTHING)) : background_pixel(view.background);
    const bool is_known = !image.rgba.empty();
    if (!is_known) image = {view.width, rows.count, {}};
    const int end = rows.first + rows.count;
    for (int row = rows.first; row < end && !is_known; row += marched.band.y) {
        const int drawn_end = std::min(parts.draw_mix(marched, row), end);
        marched.band = glm::ivec4(row, std::min(band_rows, drawn_end - row), shown, int(background));
        parts.marcher.begin_frame(marched, parts.tree, parts.pool, is_blended, parts.drawn);
        march_band(row);
        std::vector<std::uint8_t> band = parts.marcher.read_image();
        if (image.rgba.empty()) {
            image.rgba = std::move(band);
        } else {
            image.rgba.insert(image.rgba.end(), band.begin(), band.end());
        }
    }

    if (!is_known && !shows_light && statistics.converged) parts.picture.keep(view, rows, image);
    parts.note_caches(before);
    statistics.milliseconds = milliseconds_since(start);
    return image;
}

Image Renderer::render(const View& view, const std::function<void(double)>& progress) {
    parts_->keep_nothing();
    return march(view, {0, view.height}, int(view.show), [&](int row) {
        parts_->converge(progress, double(view.width) * view.height, double(view.width) * row);
    });
}

LightShares Renderer::light_shares(const View& view, const std::function<void(double)>& progress) {
    if (!parts_->marcher.has_soft_shadows()) {
        throw Error(Fault::usage, "view", "the light at a volume is not that of one place",
                    "render its picture");
    }
    parts_->keep_nothing();
    const Image bits = march(view, {0, view.height}, SHOW_LIGHT, [&](int row) {
        parts_->converge(progress, double(view.width) * view.height, double(view.width) * row);
    });
    LightShares out{view.width, view.height, std::vector<float>(bits.rgba.size() / sizeof(float))};
    std::memcpy(out.shares.data(), bits.rgba.data(), bits.rgba.size());
    return out;
}

Image Renderer::render_rows(const View& view, Rows rows) {
    parts_->keep_nothing();
    return march(view, rows, int(view.show), [&](int) { parts_->converge({}, 0.0, 0.0); });
}

Image Renderer::render_within(const View& view, double budget_ms) {
    return render_rows_within(view, {0, view.height}, budget_ms);
}

Image Renderer::render_rows_within(const View& view, Rows rows, double budget_ms) {
    parts_->require_lists();
    const auto deadline = deadline_in(budget_ms);
    parts_->keep_what_was_used_for(view, rows);
    return march(view, rows, int(view.show), [&](int) { parts_->refine(deadline); });
}

std::uint64_t Renderer::prefetch(const View& next, double budget_ms) {
    check(next);
    const auto deadline = deadline_in(budget_ms);
    Parts& parts = *parts_;
    parts.require_lists();
    const bool is_blended = parts.blends(next);
    if (parts.is_empty()) return 0;
    const FrameStatistics of_frame = parts.statistics;
    const View thin = thinned(next);
    interop::MarchView marched = parts.march_view_of(thin);
    marched.band = glm::ivec4(0, thin.height, int(thin.show), int(background_pixel(thin.background)));
    parts.tree.keep_since(parts.frame_round);
    parts.marcher.begin_frame(marched, parts.tree, parts.pool, is_blended);
    while (Clock::now() < deadline) {
        const PassResult pass = parts.march(PassKind::progressive);
        if (!parts.serve_until(deadline, pass, {.ahead = true}) || pass.done()) break;
    }
    const std::uint64_t produced = parts.statistics.bricks_produced - of_frame.bricks_produced;
    parts.prefetched += produced;
    parts.statistics = of_frame;
    return produced;
}

Prefetched Renderer::prefetch_finer(double budget_ms) {
    const auto deadline = deadline_in(budget_ms);
    Parts& parts = *parts_;
    parts.require_lists();
    if (parts.is_empty()) return {};
    const FrameStatistics of_frame = parts.statistics;
    while (!parts.ahead.done && Clock::now() < deadline)
        parts.look_ahead(deadline);
    const std::uint64_t produced = parts.statistics.bricks_produced - of_frame.bricks_produced;
    parts.prefetched += produced;
    parts.statistics = of_frame;
    return {produced, !parts.ahead.done};
}

void Renderer::forget_picture() {
    parts_->picture.forget();
}

const FrameStatistics& Renderer::statistics() const {
    return parts_->statistics;
}

}  // namespace cairn::renderer

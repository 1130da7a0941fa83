#include "bench/peers/occlusion_queries.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "renderer/march/march_view.h"

namespace cairn::bench {

using renderer::PassKind;

namespace {

constexpr std::size_t node_pool_bytes = std::size_t(32) << 20U;

renderer::ContentProgram saturating() {
    renderer::ContentProgram program;
    program.primary = "bench/saturate.comp.glsl";
    return program;
}

interop::MarchView marched_view(const renderer::View& view, const renderer::Content& content,
                                const renderer::TreeShape& shape) {
    renderer::check_view(view, shape);
    if (content.has_constant() || !content.channels().normal) {
        throw Error(Fault::usage, "visibility", "a volume has no depth at which all rays end",
                    "choose a scene of surfaces");
    }
    if (renderer::Marcher::band_rows(view.size.width, view.size.height) < view.size.height) {
        throw Error(Fault::usage, "visibility", "the picture is too large to be marched at once",
                    "choose fewer pixels");
    }
    renderer::View primary = view;
    primary.shadow.kind = renderer::ShadowQuality::Kind::none;
    interop::MarchView marched = renderer::march_view(primary, content.grid(), shape, nullptr);
    marched.surface_color = content.uniform_color();
    marched.shown = SHOW_SURFACE;
    return marched;
}

}  // namespace

std::size_t tiles_in_frustum(renderer::Content& content, const renderer::TreeShape& shape,
                             const renderer::View& view) {
    const ViewTest test(marched_view(view, content, shape), shape);
    renderer::Tree tree(shape, 1, node_pool_bytes, content.oracle().child_mask(renderer::Tile{}));
    return list_tiles(tree, content.oracle(), test).size();
}

VisibleBricks::VisibleBricks(std::unique_ptr<renderer::Content> content, const renderer::TreeShape& shape,
                             const renderer::View& view, std::size_t brick_pool_bytes,
                             const gl::ShaderSource& shaders)
    : view_(marched_view(view, *content, shape)),
      cache_(std::move(content), {node_pool_bytes, brick_pool_bytes}),
      test_(view_, shape),
      saturate_(shape, cache_.content().channels(), {}, shaders, saturating()),
      picture_(shape, cache_.content().channels(), {}, shaders),
      boxes_(view_, shaders) {
    draw();  // compiles shaders before anything is timed
}

void VisibleBricks::begin() {
    tiles_ = list_tiles(cache_.tree(), cache_.content().oracle(), test_);
    cache_.upload();
    result_.tiles_in_frustum = tiles_.size();
    round_ = round_.next();
    cache_.begin_round(round_, std::vector<std::uint32_t>(std::size_t(cache_.pool().slot_count()), 0));
}

void VisibleBricks::load(Tiles tiles) {
    if (tiles.empty()) return;
    std::vector<renderer::TileQuery> queries;
    queries.reserve(tiles.size());
    for (const ViewTile& tile : tiles)
        queries.push_back({tile.entry, renderer::QueryKind::brick});
    if (cache_.answer(queries).bricks < tiles.size()) {
        throw Error(Fault::usage, "brick pool", "it does not hold all bricks that are to be produced",
                    "choose fewer pixels");
    }
    cache_.upload();
    result_.bricks_produced += tiles.size();
    ++result_.batches;
}

/// Does not draw if there are no new bricks, because the picture stays the same.
void VisibleBricks::load_and_draw(Tiles tiles) {
    load(tiles);
    if (!tiles.empty()) draw();
}

/// Advances the round for the marchers alone. No brick is evicted, because the pool holds all bricks of one
/// decision.
renderer::PassResult VisibleBricks::march(renderer::Marcher& marcher, PassKind kind) {
    round_ = round_.next();
    return marcher.run_pass(round_, cache_.tree(), cache_.pool(), kind);
}

/// Marches the picture through the bricks that are there, and reads the depths where rays end.
void VisibleBricks::draw() {
    interop::MarchView view = view_;
    view.background_pixel = 0;  // rays that meet nothing get through
    saturate_.begin_frame(view, cache_.tree(), cache_.pool(), false);
    while (!march(saturate_, PassKind::stand_in).done()) {
    }
    const std::vector<std::uint8_t> bytes = saturate_.read_image();
    std::vector<float> inverse_depths(bytes.size() / sizeof(float));
    std::memcpy(inverse_depths.data(), bytes.data(), bytes.size());
    boxes_.set_depths(inverse_depths);
}

void VisibleBricks::test(Tiles tiles) {
    std::vector<renderer::Box> boxes;
    for (const ViewTile& tile : tiles)
        boxes.push_back(test_.box_of(cache_.tree().tile(tile.entry)));
    result_.queries += boxes_.begin(boxes);
}

std::vector<ViewTile> VisibleBricks::visible_of(Tiles tested) const {
    const std::vector<bool> visible = boxes_.visible();
    std::vector<ViewTile> tiles;
    for (std::size_t i = 0; i < tested.size(); ++i)
        if (visible[i]) tiles.push_back(tested[i]);
    return tiles;
}

/// Renders the picture, and counts the bricks that its rays read and miss: a check that no visible brick was
/// left out.
void VisibleBricks::show() {
    picture_.begin_frame(view_, cache_.tree(), cache_.pool(), false);
    renderer::PassResult pass;
    do {
        pass = march(picture_, PassKind::patient);
    } while (!pass.done() && pass.queries.empty());
    result_.missed = pass.queries.size();
    for (const std::uint32_t stamp : pass.brick_stamps)
        result_.bricks_used += stamp != 0 ? 1 : 0;
    while (!pass.done())
        pass = march(picture_, PassKind::stand_in);
    result_.image = {view_.width, view_.height, picture_.read_image()};
}

Visibility VisibleBricks::by_frustum() {
    const auto start = Clock::now();
    begin();
    load(tiles_);
    show();
    result_.milliseconds = milliseconds_since(start);
    return std::exchange(result_, {});
}

Visibility VisibleBricks::by_queries(const QuerySchedule& schedule) {
    const auto start = Clock::now();
    begin();
    std::size_t next = 0;
    auto take = [&](double count) {
        const std::size_t taken = std::min(tiles_.size() - next, std::size_t(std::ceil(count)));
        next += taken;
        return Tiles(tiles_).subspan(next - taken, taken);
    };
    std::vector<ViewTile> to_load;
    if (schedule.overlapped) {
        const Tiles untested = take(schedule.tests * schedule.loads_per_test);
        to_load.assign(untested.begin(), untested.end());
    }
    Tiles under_test = take(schedule.tests);
    test(under_test);
    while (!under_test.empty() || !to_load.empty()) {
        if (schedule.overlapped) {
            load_and_draw(to_load);
            to_load = visible_of(under_test);
        } else {
            to_load = visible_of(under_test);
            load_and_draw(to_load);
            to_load.clear();
        }
        const double visible = double(to_load.size());
        under_test = take(std::max(visible / schedule.loads_per_test, double(schedule.tests)));
        test(under_test);
    }
    show();
    result_.milliseconds = milliseconds_since(start);
    return std::exchange(result_, {});
}

}  // namespace cairn::bench

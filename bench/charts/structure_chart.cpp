// Crassin 2007, section 3.7, on its test object: frames at four places beside rays through a regular grid
// (Figure 3.24), and frames of trees of different N and M (Figure 3.26).
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/peers/regular_grid.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/samples.h"
#include "renderer/open_content.h"
#include "renderer/produce/made_fields.h"

namespace cairn::bench {
namespace {

constexpr int picture = 256;
constexpr double inner = 0.25;
constexpr double outer = 0.30;
// Depth of density 1 per voxel: opaque after a few voxels.
constexpr double optical_depth = 1.0;
/// Places of the eye on the axis through the middle of the cube [0, 1]^3. It looks towards greater ones.
constexpr std::array places = {0.5, 0.0, -0.5, -1.0};
constexpr double place_of_shapes = -0.5;

renderer::View view_from(double place) {
    renderer::View view;
    view.size = {picture, picture};
    view.camera.eye = glm::dvec3(0.0, 0.0, place - 0.5);
    view.camera.target = view.camera.eye + glm::dvec3(0.0, 0.0, 1.0);
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    return view;
}

double difference(const optics::Image& ours, const std::vector<float>& alpha) {
    double sum = 0.0;
    for (std::size_t i = 0; i < alpha.size(); ++i)
        sum += std::abs(double(ours.rgba[4 * i + 3]) / 255.0 - double(alpha[i]));
    return sum / double(alpha.size());
}

class Structures {
public:
    Structures(const ChartOptions& options, int resolution, Chart& chart)
        : options_(options),
          resolution_(resolution),
          chart_(chart),
          grid_(renderer::HollowSphere(2, resolution, inner, outer, 1.0), optical_depth * resolution) {}

    void at_places() {
        constexpr std::array traversals = {renderer::Traversal::restart, renderer::Traversal::stackless,
                                           renderer::Traversal::mini_stack};
        const int m = least_m();
        std::vector<std::shared_ptr<renderer::Renderer>> made;
        made.reserve(traversals.size());
        for (const auto traversal : traversals)
            made.push_back(std::make_shared<renderer::Renderer>(make(4, m, traversal)));
        for (const double place : places) {
            const renderer::View view = view_from(place);
            std::vector<FrameContender> contenders;
            shapes_.clear();
            for (std::size_t i = 0; i < made.size(); ++i) {
                shapes_.push_back({4, m, traversals[i]});
                contenders.emplace_back(made[i], view);
            }
            run(contenders, view, place, "place");
        }
    }

    void shapes() {
        const renderer::View view = view_from(place_of_shapes);
        std::vector<FrameContender> contenders;
        shapes_.clear();
        for (const int n : {2, 4, 8}) {
            for (const int m : {8, 16, 32, 64}) {
                // N does not matter if the tree has no levels.
                if (!fits(n, m) || (m == resolution_ && n > 2)) continue;
                shapes_.push_back({n, m, renderer::Traversal::mini_stack});
                contenders.emplace_back(make(n, m, renderer::Traversal::mini_stack), view);
            }
        }
        run(contenders, view, place_of_shapes, "shape");
    }

private:
    struct Shape {
        int n, m;
        renderer::Traversal traversal;
    };

    [[nodiscard]] bool fits(int n, int m) const {
        return m <= resolution_ && renderer::tree_shape_of(options_of(n, m)).resolution() == resolution_;
    }
    /// The least M with which a tree with N = 4 has exactly the resolution.
    [[nodiscard]] int least_m() const {
        for (const int m : {8, 16, 32, 64})
            if (fits(4, m)) return m;
        throw Error(Fault::usage, "--resolutions", fmt::format("no tree has {} voxels per side", resolution_),
                    "choose powers of two from 8 to 32768");
    }
    [[nodiscard]] renderer::TreeOptions options_of(int n, int m) const {
        return {.n = n, .m = m, .max_resolution = resolution_};
    }

    [[nodiscard]] renderer::Renderer make(int n, int m, renderer::Traversal traversal) const {
        const auto field = std::make_shared<renderer::HollowSphere>(n, resolution_, inner, outer, 1.0);
        const renderer::TransferFunction transfer(
            {{0.0, glm::dvec3(0.9), 0.0}, {1.0, glm::dvec3(0.9), optical_depth * resolution_}});
        const VoxelOptions& voxels = options_.voxels;
        return renderer::Renderer(
            renderer::volume_content(field, transfer, options_of(n, m),
                                     voxels.volume({.full_gradient = 0.0})),
            voxels.renderer({.pools = {.brick_bytes = 64U << 20U}, .march = {.traversal = traversal}}),
            options_.shaders);
    }

    void run(std::vector<FrameContender>& contenders, const renderer::View& view, double place,
             const char* varied) {
        RegularGrid::Result grid = grid_.march(view);
        std::vector<double> grid_ms;
        double spent_ms = 0.0;
        const double budget_ms = options_.budget_ms * double(contenders.size());
        for (int i = 0; i < options_.runs && spent_ms <= budget_ms; ++i) {
            measure_in_turn(contenders, 1, options_.budget_ms);
            for (const FrameContender& contender : contenders)
                spent_ms += contender.samples_ms.back();
            grid_ms.push_back(grid_.march(view).milliseconds);
        }
        const double ms = median(grid_ms);
        add(varied, place, "regular-grid", Cell{}, Cell{}, Cell{}, ms, 1.0, 0.0);
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            const Shape& shape = shapes_[i];
            std::vector<double> ratios;
            for (std::size_t r = 0; r < grid_ms.size(); ++r)
                ratios.push_back(grid_ms[r] / contenders[i].samples_ms[r]);
            constexpr std::array names = {"restart", "stackless", "mini-stack"};
            add(varied, place, names[std::size_t(shape.traversal)], std::int64_t(shape.n),
                std::int64_t(shape.m),
                std::int64_t(renderer::tree_shape_of(options_of(shape.n, shape.m)).max_level),
                median(contenders[i].samples_ms), median(ratios),
                difference(contenders[i].image, grid.alpha));
        }
    }

    void add(const char* varied, double place, const char* method, Cell n, Cell m, Cell depth, double ms,
             double times, double apart) {
        chart_.table.rows.push_back(
            on_this_machine({std::string(varied), std::int64_t(resolution_), place, std::string(method),
                             std::move(n), std::move(m), std::move(depth), ms, 1000.0 / ms, times, apart}));
    }

    const ChartOptions& options_;
    int resolution_;
    Chart& chart_;
    RegularGrid grid_;
    std::vector<Shape> shapes_;  // one per contender
};

}  // namespace

Chart chart_structure(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"varied",
                           "resolution",
                           "place",
                           "method",
                           "n",
                           "m",
                           "depth",
                           "ms",
                           "frames_a_second",
                           "times_the_grid",
                           "coverage_difference",
                           "driver",
                           "threads"};
    const std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{256, 512} : options.resolutions;
    double done = 0.0;
    for (const int resolution : resolutions) {
        Structures structures(options, resolution, chart);
        structures.at_places();
        done += 0.5 / double(resolutions.size());
        if (options.progress) options.progress(done);
        structures.shapes();
        done += 0.5 / double(resolutions.size());
        if (options.progress) options.progress(done);
    }
    write_table(chart, options.folder, "structure");
    return chart;
}

}  // namespace cairn::bench

#include "app/verbs/voxelization.h"

#include <utility>

#include <fmt/format.h>

#include "app/terminal/interrupt.h"
#include "app/terminal/measure.h"
#include "app/terminal/progress.h"
#include "app/terminal/terminal.h"
#include "base/error.h"

namespace cairn::app {

void add_voxelization_options(CLI::App& verb, VoxelizationOptions& options) {
    add_table(verb, grid_table(), options.grid);
    add_parsed_option(verb, "--method", "NAME",
                      "conservative, slice-map, three-axis, three-axis-conservative",
                      [&options](const std::string& name) {
                          try {
                              options.method = voxelizer::method_named(name);
                          } catch (const Error& error) {
                              throw Error(error.fault(), "--method", error.what(), error.way_out());
                          }
                      });
    add_common_options(verb, options.common);
}

GriddedInput load_gridded(const VoxelizationOptions& options) {
    check_grid_options(options.grid);
    Stopwatch watch;
    GriddedInput out{load_input(options.common.scene, options.common.report.quiet), {}, 0.0};
    out.grid = make_grid(options.grid, out.input.snapshot.bounds);
    out.load_ms = watch.lap_ms();
    return out;
}

Voxelization::Voxelization(const VoxelizationOptions& options, GriddedInput scene, const Needs& needs)
    : options_(options), grid_(scene.grid), load_ms_(scene.load_ms) {
    const Progress progress("preparing", options.common.report.quiet);
    Stopwatch watch;
    surface_ = voxelizer::build_surface(scene.input.scene, scene.input.snapshot, grid_,
                                        {.attributes = needs.attributes, .outside = needs.solid.has_value()});
    scene.input = {};  // what follows needs the memory
    triangle_count_ = surface_->triangle_count;
    index_.emplace(*surface_);
    surface_ms_ = watch.lap_ms();
    if (needs.solid) {
        rule_ = *needs.solid;
        build_solid(needs.doubts);
    }
    fill_ms_ = watch.lap_ms();
    driver_.emplace(options.common.driver);
    context_ms_ = watch.lap_ms();
    on_gpu_ = voxelizer::upload(*surface_);
    upload_ms_ = watch.lap_ms();
    if (!needs.surface) surface_.reset();
    voxelizer_ = voxelizer::make_voxelizer(options.method, options.common.driver.shaders);
    if (needs.attributes) attributes_.emplace(options.common.driver.shaders);
}

void Voxelization::build_solid(bool needs_doubts) {
    const ReportOptions& report = options_.common.report;
    // Doubts need a surface without gaps, and somebody who is told of them.
    const bool doubts =
        options_.method == voxelizer::Method::conservative && (needs_doubts || !report.quiet || report.json);
    solid_.emplace(*surface_, grid_, voxelizer::SolidOptions{.rule = rule_, .doubts = doubts});
    const std::optional<voxelizer::SolidFill>& crossings = solid_->crossings();
    if (!crossings || crossings->doubtful_rows() == 0 || options_.common.report.quiet) return;
    warn(
        fmt::format("the surface is not closed{} along {} of {} rows of voxels: there only what rows along "
                    "other axes agree on was filled",
                    rule_ == voxelizer::SolidRule::winding ? ", or not turned one way," : "",
                    crossings->doubtful_rows(), crossings->row_count()));
}

void Voxelization::warn_of_doubts() const {
    if (options_.common.report.quiet) return;
    const std::optional<voxelizer::Doubts>& doubts = solid_->doubts();
    if (options_.method != voxelizer::Method::conservative) return;
    if (!doubts) {
        warn(
            "doubtful voxels were not looked for: what the outside reaches would take more memory than it "
            "may");
        return;
    }
    if (doubts->enclosed > 0) {
        warn(fmt::format(
            "{} voxels stayed empty, though the surface encloses them: faces are doubled, missing "
            "or cut by a mask, walls are thinner than a voxel, or parts are turned against each "
            "other; --fill outside fills them",
            doubts->enclosed));
    }
    if (doubts->reached > 0) {
        warn(
            fmt::format("{} voxels were filled, though the outside reaches them through a hole; --fill "
                        "outside leaves them empty",
                        doubts->reached));
    }
}

void Voxelization::check_doubts() const {
    if (solid_->looks_for_doubts()) return;
    throw Error(Fault::memory, "--doubtful", "what the outside reaches takes more memory than it may",
                "choose fewer voxels");
}

void Voxelization::finish_solid(const voxelizer::TileSink& sink, const voxelizer::TileSink& doubtful) {
    double elsewhere_ms = 0.0;  // what attributes and writers take
    const auto timed = [&elsewhere_ms](const voxelizer::TileSink& to) {
        return [&elsewhere_ms, &to](voxelizer::VoxelTile&& tile) {
            Stopwatch watch;
            to(std::move(tile));
            elsewhere_ms += watch.lap_ms();
        };
    };
    Stopwatch watch;
    solid_->finish(timed(sink), doubtful ? timed(doubtful) : voxelizer::TileSink());
    fill_ms_ += watch.lap_ms() - elsewhere_ms;
}

void Voxelization::add_attributes(voxelizer::VoxelTile& tile) {
    if (!attributes_) return;
    Stopwatch watch;
    const voxelizer::Region region{grid_.level(), tile.origin, tile.bits.size};
    tile.attributes = attributes_->gather(on_gpu_, region, tile.bits, index_->triangles_in(region));
    attributes_ms_ += watch.lap_ms();
}

void Voxelization::run(const voxelizer::TileSink& sink, const voxelizer::TileProgress& progress,
                       const voxelizer::TileSink& doubtful) {
    voxelizer::TileSink with_attributes = [&](voxelizer::VoxelTile&& tile) {
        add_attributes(tile);
        sink(std::move(tile));
    };
    statistics_ = voxelizer::voxelize_tiles(
        *voxelizer_, on_gpu_, *index_, grid_,
        solid_ ? [&](voxelizer::VoxelTile&& tile) {
            solid_->add(std::move(tile), with_attributes);
            if (doubtful) check_doubts();
        } : with_attributes,
        [&progress](double share) { return !Interrupt::asked() && progress(share); }, {.warm_up = true});
    if (solid_) {
        finish_solid(with_attributes, doubtful);
        statistics_.occupied = solid_->occupied();
        if (doubtful) check_doubts();
        warn_of_doubts();
    }
    driver_->check();
}

void Voxelization::report(Report& report) const {
    report.add("scene", options_.common.scene.scene);
    report.add("triangles", triangle_count_);
    report.add("resolution", resolution_of(grid_));
    report.add("origin", json_of(grid_.origin));
    report.add("voxel_size", grid_.voxel_size);
    report.add("method", std::string(voxelizer::name_of(options_.method)));
    report.add("occupied", statistics_.occupied);
    report.add("milliseconds", statistics_.milliseconds);
    report.add("regions", statistics_.regions);
    if (solid_) {
        report.add("fill_rule", name_of(std::optional(rule_), fill_names()));
        report.add("fill_ms", fill_ms_);
        if (solid_->crossings()) report.add("doubtful_rows", solid_->crossings()->doubtful_rows());
        const std::optional<voxelizer::Doubts>& doubts = solid_->doubts();
        report.add("doubtful_enclosed", doubts ? Json(doubts->enclosed) : Json());
        report.add("doubtful_reached", doubts ? Json(doubts->reached) : Json());
    }
    if (attributes_) report.add("attributes_ms", attributes_ms_);
    report.add("load_ms", load_ms_);
    report.add("surface_ms", surface_ms_);
    report.add("context_ms", context_ms_);
    report.add("upload_ms", upload_ms_);
    report.add("driver", driver_->name());
    report.add("backend", driver_->backend());
}

const Names<std::optional<voxelizer::SolidRule>>& fill_names() {
    using voxelizer::SolidRule;
    static const Names<std::optional<SolidRule>> names = {{"surface", std::nullopt},
                                                          {"winding", SolidRule::winding},
                                                          {"solid", SolidRule::winding},
                                                          {"parity", SolidRule::parity},
                                                          {"outside", SolidRule::outside}};
    return names;
}

Json resolution_of(const voxelizer::Grid& grid) {
    const glm::ivec3& r = grid.resolution;
    return r.x == r.y && r.y == r.z ? Json(r.x) : json_of(r);
}

}  // namespace cairn::app

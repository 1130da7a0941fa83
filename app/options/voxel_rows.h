#pragma once

#include <string>

#include <fmt/format.h>

#include "app/options/names.h"
#include "app/options/option_table.h"
#include "renderer/march/march_options.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/volume.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/volume.h"

/// Rows of the options that say how voxels are rendered, for every verb that has them. `member` is
/// as in option_table.h.
namespace cairn::app {

constexpr int least_brick = 8;
constexpr int largest_brick = 81;
constexpr double most_budget_ms = 86.4e6;  ///< milliseconds of a day

[[nodiscard]] inline Names<renderer::Traversal> traversal_names() {
    using renderer::Traversal;
    return {{"restart", Traversal::restart},
            {"stackless", Traversal::stackless},
            {"mini-stack", Traversal::mini_stack}};
}
[[nodiscard]] inline Names<renderer::TileQueries> tile_query_names() {
    using renderer::TileQueries;
    return {{"list", TileQueries::list}, {"blocks", TileQueries::blocks}};
}

template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> tree_n_row(Member member) {
    return whole_row<Options>(
        "--tree-n", "N", "children of a node of the tree per axis: 2, 3, 4 or 8\n(default: 4)", 2, 8, member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> brick_m_row(Member member) {
    return whole_row<Options>("--brick-m", "M",
                              "voxels of a brick per axis: 8, 16, 32 or 64; 27 or 81 with\n--tree-n 3 "
                              "(default: 16, or 27)",
                              least_brick, largest_brick, member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> max_resolution_row(Member member) {
    return whole_row<Options>("--max-resolution", "N",
                              fmt::format("voxels across the scene at the finest level, of volumes at\nmost "
                                          "(default: {})",
                                          renderer::TreeOptions{}.max_resolution),
                              least_brick, 1 << MAX_RESOLUTION_BITS, member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> traversal_row(Member member) {
    return named_row<Options>("--traversal",
                              "how a ray finds its next tile; the picture is the same\n(default: mini-stack)",
                              traversal_names(), member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> tile_queries_row(Member member) {
    return named_row<Options>("--tile-queries",
                              "how rays ask for what is missing: a list of all tiles, or\nfour tiles per "
                              "block of pixels, in more passes; the\npicture is the same (default: list)",
                              tile_query_names(), member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> steps_row(Member member) {
    return whole_row<Options>("--steps-per-voxel", "N",
                              fmt::format("steps of a ray per voxel of a volume, 1 to {}\n(default: {})",
                                          VOLUME_MOST_STEPS, renderer::VolumeOptions{}.steps_per_voxel),
                              1, VOLUME_MOST_STEPS, member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> gradient_row(Member member) {
    return number_row<Options>(
        "--gradient-threshold", "G",
        fmt::format("change of density per voxel from which on a place of a\nvolume is "
                    "lit as a surface; 0: lit as fog everywhere\n(default: {})",
                    renderer::VolumeOptions{}.full_gradient),
        0.0, 1.0, member);
}
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> budget_row(Member member) {
    return number_row<Options>("--frame-budget", "MS",
                               "milliseconds after which a frame produces nothing more and\nshows what there "
                               "is (default: until nothing is missing)",
                               0.0, most_budget_ms, member);
}

}  // namespace cairn::app

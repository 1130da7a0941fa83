#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/charts/chart.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// A scene or a volume that charts look at, by its path; besides what `cairn render` takes:
/// builtin:hollow-sphere, the shell of Crassin 2007, section 3.7.2, and builtin:spheres-repeated, copies of
/// it of 256^3 voxels each. Both have as many voxels as the tree allows. And builtin:sponge, Menger's, in a
/// tree of its own (renderer/produce/fractal_content.h).
class Subject {
public:
    explicit Subject(const std::string& path);
    ~Subject();
    Subject(Subject&&) noexcept;
    Subject& operator=(Subject&&) noexcept;
    Subject(const Subject&) = delete;
    Subject& operator=(const Subject&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scenes::Bounds& bounds() const { return bounds_; }
    [[nodiscard]] Cell triangles() const;  ///< nothing for a volume
    /// The tree that make() and content() take for these options: others for the sponge alone.
    [[nodiscard]] renderer::TreeOptions fitted(const renderer::TreeOptions& tree) const;
    [[nodiscard]] renderer::Renderer make(const renderer::TreeOptions& tree,
                                          const gl::ShaderSource& shaders) const;
    /// Of that tree, no finer than a volume's voxels.
    [[nodiscard]] renderer::TreeShape shape(const renderer::TreeOptions& tree) const;
    /// What such a renderer shows, for those who look at it by other means.
    [[nodiscard]] std::unique_ptr<renderer::Content> content(const renderer::TreeOptions& tree,
                                                             const gl::ShaderSource& shaders) const;
    /// The whole of it.
    [[nodiscard]] renderer::View view(int width, int height) const;

private:
    struct Data;
    /// A volume or a made field, and how it is shown.
    struct Shown {
        std::shared_ptr<const renderer::Field> field;
        renderer::TransferFunction transfer;
    };
    [[nodiscard]] Shown shown_field(const renderer::TreeOptions& tree) const;
    std::unique_ptr<Data> data_;
    std::string name_;
    scenes::Bounds bounds_;
};

/// Marches a frame, whatever was shown before. @return milliseconds
double frame_ms(renderer::Renderer& renderer, const renderer::View& view);

/// Renderers whose frames are measured in turn, so that their ratios hold when the machine's speed drifts.
struct Entrant {
    std::shared_ptr<renderer::Renderer> renderer;  ///< of several, where pools hold what all of them use
    renderer::View view;
    double first_ms = 0.0;                ///< the first frame, into empty pools
    renderer::FrameStatistics first;      ///< of it
    renderer::FrameStatistics converged;  ///< of the last
    optics::Image image;                  ///< of the last
    std::vector<double> samples_ms;       ///< converged frames

    Entrant(renderer::Renderer made, const renderer::View& view);
    Entrant(std::shared_ptr<renderer::Renderer> made, const renderer::View& view);
};
/// @param budget_ms  of each, on average: no further round begins once it is spent.
void measure_in_turn(std::vector<Entrant>& entrants, int runs, double budget_ms);

/// The last two columns of every table of frames: "driver" and "threads".
[[nodiscard]] std::vector<Cell> on_this_machine(std::vector<Cell> row);

}  // namespace cairn::bench

#pragma once

#include <memory>
#include <optional>

#include "app/options/view_options.h"
#include "app/subject/scene_input.h"
#include "app/terminal/report.h"
#include "renderer/renderer.h"

namespace cairn::app {

/// What a verb shows: a scene at a moment, a volume, or one of the built-in sets.
class Subject {
public:
    /// Loads, and warns on stderr unless `quiet`. @throws Error as load_input() and scenes::load_volume() do.
    Subject(const SceneOptions& scene, const ViewOptions& options, bool quiet);

    [[nodiscard]] scenes::Bounds bounds() const;
    /// How much there is of it.
    void add_figures(Report& report) const;
    /// The view of the options; @see view_of().
    [[nodiscard]] renderer::View view(const ViewOptions& options) const;
    [[nodiscard]] renderer::Renderer make_renderer(const ViewOptions& options,
                                                   const gl::ShaderSource& shaders) const;

private:
    bool fractal_;  ///< builtin:fractal
    bool sponge_;   ///< builtin:sponge
    std::optional<SceneInput> scene_;
    std::shared_ptr<const renderer::Field> field_;  ///< when it is a volume
};

}  // namespace cairn::app

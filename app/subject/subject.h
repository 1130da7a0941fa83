#pragma once

#include <memory>

#include "app/options/view_options.h"
#include "app/terminal/report.h"
#include "renderer/open_content.h"
#include "renderer/view/view.h"

namespace cairn::app {

/// What the options ask renderer::ContentSource for, but for a scene's moment.
/// @throws Error (Fault::usage) for an option that the kind of content does not know.
[[nodiscard]] renderer::ContentOptions content_options(const SceneOptions& scene, const ViewOptions& options);

/// What a verb shows: a scene at a moment, a volume, or one of the built-in sets.
class Subject {
public:
    /// Loads, and warns on stderr unless `quiet`.
    /// @throws Error as load_input() and renderer::ContentSource do, and Fault::usage for an option that the
    /// kind of content does not know.
    Subject(const SceneOptions& scene, const ViewOptions& options, bool quiet);

    [[nodiscard]] const scenes::Bounds& bounds() const { return source_.bounds(); }
    [[nodiscard]] const renderer::TreeOptions& tree() const { return source_.tree(); }
    [[nodiscard]] renderer::ContentKind kind() const { return source_.kind(); }
    /// How much there is of it.
    void add_figures(Report& report) const;
    /// The view of the options; @see view_of(). In the fractal, the camera and the light are given from its
    /// middle, in units of its side / 2^zoom.
    [[nodiscard]] renderer::View view(const ViewOptions& options) const;
    /// Needs a context.
    [[nodiscard]] std::unique_ptr<renderer::Content> content(const gl::ShaderSource& shaders) const {
        return source_.content(shaders);
    }

private:
    renderer::ContentSource source_;
};

}  // namespace cairn::app

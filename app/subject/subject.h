#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options/view_options.h"
#include "app/terminal/report.h"
#include "renderer/open_content.h"
#include "renderer/view/view.h"

namespace cairn::app {

/// The options of renderer::ContentSource that the command's options mean, all but the moment of a scene.
/// @throws Error (Fault::usage) if an option does not apply to the kind of content.
[[nodiscard]] renderer::ContentOptions content_options(const SceneOptions& scene, const ViewOptions& options);

/// What a verb shows: a scene at a moment, a volume, or one of the built-in sets.
class Subject {
public:
    /// Loads the content. Prints its warnings (warn_of()).
    /// @throws Error as load_input() and renderer::ContentSource do; Fault::usage if an option does not apply
    /// to the kind of content.
    Subject(const SceneOptions& scene, const ViewOptions& options, bool quiet);

    [[nodiscard]] const scenes::Bounds& bounds() const { return source_.bounds(); }
    [[nodiscard]] const renderer::TreeOptions& tree() const { return source_.tree(); }
    [[nodiscard]] renderer::ContentKind kind() const { return source_.kind(); }
    /// Adds the number of triangles or voxels to the report.
    void add_figures(Report& report) const;
    /// The view that the options ask for; @see view_of(). Camera and light of the fractal are relative to its
    /// middle, in units of its side / 2^zoom.
    [[nodiscard]] renderer::View view(const ViewOptions& options) const;
    /// What of the options has no effect on the view, or another than asked for: one text for each.
    [[nodiscard]] std::vector<std::string> unmet(const ViewOptions& options,
                                                 const renderer::View& view) const;
    /// @see renderer::ContentSource::finest_resolution().
    [[nodiscard]] std::optional<std::int64_t> finest_resolution() const {
        return source_.finest_resolution();
    }
    /// The content for a renderer. Needs a current context.
    [[nodiscard]] std::unique_ptr<renderer::Content> content(const gl::ShaderSource& shaders) const {
        return source_.content(shaders);
    }

private:
    renderer::ContentSource source_;
};

}  // namespace cairn::app

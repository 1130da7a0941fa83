#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "app/options/parse.h"
#include "app/options/view_options.h"
#include "app/subject/subject.h"
#include "app/terminal/driver.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/measure.h"
#include "app/terminal/png.h"
#include "app/terminal/progress.h"
#include "app/terminal/report.h"
#include "app/terminal/terminal.h"
#include "app/verbs/verbs.h"
#include "app/viewer/canvas.h"
#include "app/viewer/input.h"
#include "app/viewer/overlay.h"
#include "app/viewer/viewer.h"
#include "gl/window.h"
#include "renderer/open_content.h"

namespace cairn::app {
namespace {

constexpr int max_frames = 1 << 30;
/// Longest wait for an event, in seconds, in case the window system drops one.
constexpr double longest_wait = 5.0;

struct Options {
    Options() {
        view.view.size = {1024, 768};
        view.view.samples = 16;  // taken while the camera rests
    }
    ReportOptions report;
    SceneOptions scene;
    DriverOptions driver;
    ViewOptions view;
    std::optional<std::filesystem::path> output;
    std::optional<int> frames;
    bool log = false;
};

void add_options(CLI::App& verb, Options& options) {
    add_output_option(
        verb, options.output, {".png"},
        "the file that the key P writes (default: the first of\ncairn-1.png, cairn-2.png, ... that "
        "does not exist)");
    add_table(verb, view_table(), options.view);
    add_parsed_option(
        verb, "--frames", "N",
        "end once N frames have been shown and nothing is left to\nrefine (default: at the "
        "key Escape)",
        [&options](const std::string& text) { options.frames = parse_int("--frames", text, 1, max_frames); });
    verb.add_flag("--log", options.log, "report each converged view and each picture on stderr");
    add_scene_argument(verb, options.scene);
    add_moment_options(verb, options.scene);
    add_shader_option(verb, options.driver);
    add_report_options(verb, options.report);
}

std::filesystem::path free_picture_name() {
    for (int i = 1;; ++i) {
        std::filesystem::path path = fmt::format("cairn-{}.png", i);
        if (!std::filesystem::exists(path)) return path;
    }
}

double scene_size(const scenes::Bounds& bounds) {
    const double diagonal = bounds.empty() ? 1.0 : glm::length(bounds.high - bounds.low);
    return diagonal > 0.0 ? diagonal : 1.0;
}

double median(std::vector<double> times) {
    if (times.empty()) return 0.0;
    const auto middle = times.begin() + std::ptrdiff_t(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
}

double longest(const std::vector<double>& times) {
    return times.empty() ? 0.0 : *std::max_element(times.begin(), times.end());
}

/// The window, from its opening to its closing.
class Explorer {
public:
    Explorer(const Options& options, gl::Window& window, Viewer& viewer)
        : options_(options),
          window_(window),
          viewer_(viewer),
          overlay_(window.native()),
          input_(window.native(), viewer) {
        viewer_.resize(window.framebuffer_size());
    }

    void run() {
        while (!window_.should_close() && !has_shown_enough()) {
            Interrupt::check();
            const double rest = viewer_.rest(glfwGetTime());
            if (rest <= 0.0 || input_.take_stir()) {
                Stopwatch watch;
                viewer_.step(glfwGetTime());
                keep_picture();
                tell_convergence();
                draw();
                longest_turn_ms_ = std::max(longest_turn_ms_, watch.lap_ms());
            }
            input_.take_events(std::min(viewer_.rest(glfwGetTime()), longest_wait));
        }
    }

    void add_figures(Report& report) const {
        report.add("frames", shown_);
        report.add("moving_frames", viewer_.frame_ms().size());
        report.add("moving_frame_ms", median(viewer_.frame_ms()));
        report.add("longest_moving_frame_ms", longest(viewer_.frame_ms()));
        report.add("slices", viewer_.slice_ms().size());
        report.add("slice_ms", median(viewer_.slice_ms()));
        report.add("longest_slice_ms", longest(viewer_.slice_ms()));
        report.add("longest_turn_ms", longest_turn_ms_);
        report.add("converged", viewer_.converged());
        report.add("bricks_produced", viewer_.bricks_produced());
        report.add("pictures", pictures_);
    }

private:
    [[nodiscard]] bool has_shown_enough() const {
        return options_.frames && shown_ >= *options_.frames && viewer_.settled();
    }

    void draw() {
        const glm::ivec2 size = window_.framebuffer_size();
        if (size.x < 1 || size.y < 1) return;  // minimized
        glViewport(0, 0, size.x, size.y);
        canvas_.draw(viewer_.base(), viewer_.base_revision(), size);
        canvas_.draw(viewer_.growing(), viewer_.growing_revision(), size);
        overlay_.draw(line(), notice_, input_.wants_help());
        glfwSwapBuffers(window_.native());
        ++shown_;
    }

    [[nodiscard]] std::string line() const {
        const renderer::View& view = viewer_.view();
        std::string text = viewer_.statistics_line();
        if (view.show != renderer::Show::surface)
            text += view.show == renderer::Show::levels ? "   tree levels" : "   bricks";
        if (view.shadow.kind == renderer::ShadowQuality::Kind::none) text += "   no shadows";
        if (view.detail.pixel_error != renderer::LevelOfDetail{}.pixel_error)
            text += fmt::format("   voxels of {:.2g} pixels", view.detail.pixel_error);
        if (viewer_.flying()) text += fmt::format("   flying, {:.3g} a second", viewer_.fly_speed());
        return text;
    }

    /// Writes a finished picture, and reports the command that renders it again.
    void keep_picture() {
        const std::optional<TakenPicture> taken = viewer_.take_picture();
        if (!taken) return;
        const std::filesystem::path path = options_.output ? *options_.output : free_picture_name();
        write_png(taken->image, path);
        const std::string command = render_command(options_.scene, options_.view, taken->view, path);
        pictures_.push_back({{"file", path.string()}, {"command", command}});
        notice_ = "wrote " + path.string();
        if (!options_.report.quiet && options_.report.json != "-") {
            (void)std::puts(command.c_str());
            (void)std::fflush(stdout);
        }
        log("picture " + path.string());
    }

    void tell_convergence() {
        const bool settled = viewer_.settled();
        if (settled && !was_settled_) {
            log(fmt::format("{} {}x{}", viewer_.converged() ? "converged" : "settled",
                            viewer_.view().size.width, viewer_.view().size.height));
        }
        was_settled_ = settled;
    }

    void log(const std::string& text) const {
        if (options_.log) tell(text + "\n");
    }

    const Options& options_;
    gl::Window& window_;
    Viewer& viewer_;
    Overlay overlay_;
    Input input_;
    Canvas canvas_;
    std::string notice_;
    Json pictures_ = Json::array();
    int shown_ = 0;
    double longest_turn_ms_ = 0.0;
    bool was_settled_ = false;
};

ExitCode run(const Options& options) {
    const bool quiet = options.report.quiet;
    Report report(options.report);
    report.add("scene", options.scene.scene);
    if (renderer::content_kind(options.scene.scene) == renderer::ContentKind::fractal) {
        throw Error(Fault::usage, options.scene.scene, "the viewer's cameras do not reach its depth",
                    "render it: cairn render builtin:fractal --zoom K");
    }
    auto subject = std::make_unique<Subject>(options.scene, options.view, quiet);
    const renderer::View view = subject->view(options.view);
    if (!quiet) {
        for (const std::string& text : subject->unmet(options.view, view))
            warn(text);
    }
    const double size = scene_size(subject->bounds());

    const std::unique_ptr<gl::Window> window =
        gl::create_window("cairn view " + options.scene.scene + " (F1: help)",
                          {view.size.width, view.size.height}, wants_debugging());
    glfwSwapInterval(1);
    // Set-up may take a while: until then the window shows the background of the scene.
    glClearColor(0.906F, 0.925F, 0.957F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    window->swap_and_poll();

    std::optional<renderer::Renderer> renderer;
    std::optional<Viewer> viewer;
    {
        const Progress progress("preparing", quiet);
        renderer.emplace(subject->content(options.driver.shaders),
                         renderer::RendererOptions{options.view.pools, options.view.march},
                         options.driver.shaders);
        subject.reset();  // the renderer has copies of all that it needs
        viewer.emplace(*renderer, view, size);
        viewer->warm_up();
    }
    {
        Explorer explorer(options, *window, *viewer);
        explorer.run();
        explorer.add_figures(report);
    }
    check_debug_log(*window);
    report.add("driver", gl::driver_name());
    report.add("backend", std::string(window->backend()));
    report.finish();
    return ExitCode::done;
}

}  // namespace

void add_view(CLI::App& command, Work& chosen) {
    add_verb<Options>(command, chosen, "view", "Explore a scene in a window", add_options, run);
}

}  // namespace cairn::app

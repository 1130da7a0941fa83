#include "renderer/renderer.h"

#include <cstring>
#include <utility>
#include <vector>

#include "base/error.h"
#include "renderer/frame/frame_loop.h"
#include "renderer/mesh/mix.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

Renderer::Renderer(std::unique_ptr<Content> content, const RendererOptions& options,
                   const gl::ShaderSource& shaders)
    : loop_(std::make_unique<FrameLoop>(std::move(content), options.pools, options.march, shaders)) {}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_mix(const Mix& mix) {
    loop_->set_mix(mix);
}

Frame Renderer::render(const View& view, const Request& request) {
    const Rows rows = request.rows.value_or(Rows{0, view.size.height});
    const int shown = int(view.show);
    optics::Image image = request.budget
                              ? loop_->render_until(view, rows, shown, deadline_in(*request.budget))
                              : loop_->render(view, rows, shown, request.progress);
    return {std::move(image), loop_->statistics()};
}

LightFrame Renderer::light(const View& view, const Progress& progress) {
    if (!loop_->shows_surface()) {
        throw Error(Fault::usage, "view", "the light at a volume is not that of one place",
                    "render its picture");
    }
    const optics::Image bits = loop_->render(view, {0, view.size.height}, SHOW_LIGHT, progress);
    std::vector<float> shares(bits.rgba.size() / sizeof(float));
    std::memcpy(shares.data(), bits.rgba.data(), bits.rgba.size());
    return {{view.size.width, view.size.height, std::move(shares)}, loop_->statistics()};
}

std::uint64_t Renderer::prefetch(const View& next, Milliseconds budget) {
    return loop_->prefetch(next, deadline_in(budget));
}

PrefetchResult Renderer::prefetch_finer(Milliseconds budget) {
    return loop_->prefetch_finer(deadline_in(budget));
}

void Renderer::forget_picture() {
    loop_->forget_picture();
}

}  // namespace cairn::renderer

#include "bench/trials/frame_contenders.h"

#include <thread>
#include <utility>

#include "gl/context.h"

namespace cairn::bench {

double frame_ms(renderer::Renderer& renderer, const renderer::View& view) {
    renderer.forget_picture();
    (void)renderer.render(view);
    return renderer.statistics().milliseconds;
}

FrameContender::FrameContender(renderer::Renderer made, const renderer::View& looks)
    : FrameContender(std::make_shared<renderer::Renderer>(std::move(made)), looks) {}

FrameContender::FrameContender(std::shared_ptr<renderer::Renderer> made, const renderer::View& looks)
    : renderer(std::move(made)), view(looks) {
    first_ms = frame_ms(*renderer, view);
    first = renderer->statistics();
}

void measure_in_turn(std::vector<FrameContender>& contenders, int runs, double budget_ms) {
    double spent_ms = 0.0;
    for (int run = 0; run < runs && spent_ms <= budget_ms * double(contenders.size()); ++run) {
        for (FrameContender& contender : contenders) {
            contender.renderer->forget_picture();
            contender.image = contender.renderer->render(contender.view);
            contender.converged = contender.renderer->statistics();
            contender.samples_ms.push_back(contender.converged.milliseconds);
            spent_ms += contender.samples_ms.back();
        }
    }
}

std::vector<Cell> on_this_machine(std::vector<Cell> row) {
    row.emplace_back(gl::driver_name());
    row.emplace_back(std::int64_t(std::thread::hardware_concurrency()));
    return row;
}

}  // namespace cairn::bench

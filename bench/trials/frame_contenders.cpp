#include "bench/trials/frame_contenders.h"

#include <thread>
#include <utility>

#include "gl/context.h"

namespace cairn::bench {

renderer::Frame marched_frame(renderer::Renderer& renderer, const renderer::View& view,
                              const renderer::Request& request) {
    renderer.forget_picture();
    return renderer.render(view, request);
}

FrameContender::FrameContender(renderer::Renderer made, const renderer::View& looks)
    : FrameContender(std::make_shared<renderer::Renderer>(std::move(made)), looks) {}

FrameContender::FrameContender(std::shared_ptr<renderer::Renderer> made, const renderer::View& looks)
    : renderer(std::move(made)), view(looks) {
    first = marched_frame(*renderer, view).statistics;
    first_ms = first.milliseconds;
}

void measure_in_turn(std::vector<FrameContender>& contenders, int runs, double budget_ms) {
    double spent_ms = 0.0;
    for (int run = 0; run < runs && spent_ms <= budget_ms * double(contenders.size()); ++run) {
        for (FrameContender& contender : contenders) {
            renderer::Frame frame = marched_frame(*contender.renderer, contender.view);
            contender.image = std::move(frame.image);
            contender.converged = frame.statistics;
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

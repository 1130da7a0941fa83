#include <cmath>

#include "renderer/renderer.h"
#include "shaders/interop/config.h"

namespace cairn::renderer {

static_assert(int(Show::surface) == SHOW_SURFACE && int(Show::levels) == SHOW_LEVELS &&
              int(Show::bricks) == SHOW_BRICKS);

glm::vec3 shown_level_color(double level) {
    const auto channel = [level](double phase) {
        return float(0.5 + 0.5 * std::cos(LEVEL_HUE * level + phase));
    };
    return {channel(LEVEL_PHASE_R), channel(LEVEL_PHASE_G), channel(LEVEL_PHASE_B)};
}

}  // namespace cairn::renderer

#include "renderer/shadow/shadow_base.h"

#include "base/error.h"

namespace cairn::renderer {

void ShadowRenderer::move_to(double /*seconds*/) {
    throw Error(Fault::usage, "moving scene", "the renderer was made for one moment",
                "make it with the motion of its scene");
}

}  // namespace cairn::renderer

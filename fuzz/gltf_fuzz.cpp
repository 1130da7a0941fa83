#include <utility>

#include "base/error.h"
#include "fuzz/scratch.h"
#include "fuzz/targets.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::fuzz {

void gltf(Bytes file) {
    // The first bytes of a file, not its name, decide whether it is a .glb.
    const std::string path = scratch_file("scene.glb", file);
    try {
        const scenes::Scene scene = scenes::load(path);
        (void)scenes::take_snapshot(scene);
        for (int animation = 0; std::cmp_less(animation, scene.animations.size()); ++animation)
            (void)scenes::take_snapshot(scene, {0.5, animation, std::nullopt});
    } catch (const Error& error) {
        if (error.fault() != Fault::input && error.fault() != Fault::memory)
            broken_promise("a damaged scene is Fault::input, one that takes too much Fault::memory");
    }
}

}  // namespace cairn::fuzz

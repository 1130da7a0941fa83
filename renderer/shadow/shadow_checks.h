#pragma once

#include "renderer/shadow/shadow_base.h"
#include "renderer/view/view.h"

/// Checks that several methods of shadows share.
namespace cairn::renderer {

/// For methods whose rays meet all of the snapshot.
/// @throws Error  Fault::usage if a node of the snapshot is no caster or no receiver.
void check_casts_and_receives_all(const ShadowScene& scene);
/// @throws Error  Fault::usage if a selection does not have one flag per node.
void check_selections(const ShadowScene& scene);
/// @throws Error  Fault::usage if the view shows anything other than Show::surface.
void check_shows_surface(const View& view);

}  // namespace cairn::renderer

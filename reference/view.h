#pragma once

#include "optics/camera.h"
#include "optics/light.h"
#include "reference/area_light.h"
#include "reference/image.h"
#include "scenes/snapshot.h"

/// The renderer's cameras and lights, as the reference takes them.
namespace cairn::reference {

[[nodiscard]] ReferenceCamera camera_of(const optics::Camera& camera);

/// Its middle.
[[nodiscard]] ReferenceLight light_of(const optics::Light& light);

/// All of it. A directional light stands as a sphere 1e5 scene diagonals away.
[[nodiscard]] AreaLight area_light_of(const optics::Light& light, const scenes::Bounds& scene);

}  // namespace cairn::reference

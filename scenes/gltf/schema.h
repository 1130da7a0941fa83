#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "scenes/load.h"

namespace cairn::scenes::gltf {

/// Checks the JSON of a glTF file before tinygltf reads it: every property that the loader uses has its right
/// type, required properties are there, and every index points into an array that is long enough. Later steps
/// need not check an index against its array again, except the sampler of an animation channel, whose index
/// is local to its animation.
///
/// The document is changed where tinygltf might misread it: whole numbers written as 3.0 become integers, and
/// every property that the loader does not read is removed ("extras", unknown extensions, min and max, ...).
/// @throws Error  that names the element, its property and what is wrong with it, or which limit it passes.
void check_schema(const std::string& name, nlohmann::json& document, const Limits& limits);

}  // namespace cairn::scenes::gltf

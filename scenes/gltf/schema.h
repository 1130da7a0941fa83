#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace cairn::scenes::gltf {

/// Checks the JSON of a glTF file before tinygltf reads it: every property that the loader uses has its right
/// type, what is required is there, and every index points into an array that is long enough. After it, no
/// index needs a check against its array again (an animation channel's sampler excepted, which is local to
/// its animation).
///
/// What tinygltf might take amiss is made regular: whole numbers written as 3.0 become integers, and every
/// property that the loader does not read goes ("extras", unknown extensions, min and max, ...).
/// @throws Error  naming the element, its property and what is wrong with it.
void check_schema(const std::string& name, nlohmann::json& document);

}  // namespace cairn::scenes::gltf

#pragma once

#include <filesystem>
#include <string>

#include "fuzz/targets.h"

namespace cairn::fuzz {

/// A folder of this process alone, made when it is first asked for and removed when the process ends.
[[nodiscard]] const std::filesystem::path& scratch_folder();

/// Writes a file into the scratch folder, in place of a file of that name. @return its path.
[[nodiscard]] std::string scratch_file(const std::string& name, Bytes bytes);

}  // namespace cairn::fuzz

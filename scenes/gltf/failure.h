#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cairn::scenes::gltf {

/// The way out of most errors.
inline constexpr const char* damaged = "the file is damaged; export it again";

/// @throws Error (Fault::input), always.
[[noreturn]] void fail(const std::string& where, const std::string& what,
                       const std::string& way_out = damaged);

/// Text of a file, made fit for one line of a message: in double quotes, short, without control characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The name of an element in messages: `mesh 2 "ear"`, or `mesh 2` if the element has no name.
[[nodiscard]] std::string element(std::string_view kind, std::size_t index, std::string_view name = {});

}  // namespace cairn::scenes::gltf

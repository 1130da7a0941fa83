#pragma once

#include <cstddef>

namespace cairn::test {

/// Number of calls of `new` in this thread, by drivers and libraries too. Counts in programs that link
/// count_news.cpp.
[[nodiscard]] std::size_t news();
/// Bytes that those calls asked for.
[[nodiscard]] std::size_t new_bytes();

}  // namespace cairn::test

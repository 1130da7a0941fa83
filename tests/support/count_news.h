#pragma once

#include <cstddef>

namespace cairn::test {

/// Number of calls of `new` in this thread, by drivers and libraries too. Counts in programs that link
/// count_news.cpp.
[[nodiscard]] std::size_t news();

}  // namespace cairn::test

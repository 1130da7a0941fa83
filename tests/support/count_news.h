#pragma once

#include <cstddef>

namespace cairn::test {

/// How often this thread has taken memory with `new`, drivers and libraries included. A test program that
/// links count_news.cpp counts.
[[nodiscard]] std::size_t news();

}  // namespace cairn::test

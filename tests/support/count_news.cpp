// The operator is replaced in a file of its own, so that compilers do not inline it.
#include "tests/support/count_news.h"

#include <cstdlib>
#include <new>

namespace {
thread_local std::size_t count = 0;
thread_local std::size_t bytes = 0;
}  // namespace

void* operator new(std::size_t size) {
    ++count;
    bytes += size;
    if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++count;
    bytes += size;
    return std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

std::size_t cairn::test::news() {
    return count;
}

std::size_t cairn::test::new_bytes() {
    return bytes;
}

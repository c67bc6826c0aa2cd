// SPDX-License-Identifier: Apache-2.0
// Replaces operator new by one that counts.
#include "master/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::uint64_t> count{0};
}

std::uint64_t dpchip::test::allocations() { return count; }

void* operator new(std::size_t size) {
    ++count;
    if (void* const p = std::malloc(size)) return p;
    throw std::bad_alloc{};
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++count;
    return std::malloc(size);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

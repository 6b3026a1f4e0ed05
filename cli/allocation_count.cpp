// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> allocations = 0;

void* count(void* memory) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    if (memory == nullptr)
        throw std::bad_alloc();
    return memory;
}

std::size_t atLeastOne(std::size_t bytes) {
    return bytes == 0 ? 1 : bytes;
}

} // namespace

// The standard's array forms call these. The nothrow form is here too: sanitizers bring one of
// their own, which would not match the delete below.
void* operator new(std::size_t bytes) {
    return count(std::malloc(atLeastOne(bytes)));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    const auto align = static_cast<std::size_t>(alignment);
    return count(std::aligned_alloc(align, (atLeastOne(bytes) + align - 1) / align * align));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    allocations.fetch_add(1, std::memory_order_relaxed);
    return std::malloc(atLeastOne(bytes));
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace hone::cli {

std::uint64_t allocationCount() {
    return allocations.load(std::memory_order_relaxed);
}

} // namespace hone::cli

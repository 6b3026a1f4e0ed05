// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <vector>

namespace hone {

/// What devices take host memory in (Device::importBuffer): the usual page of the processors that
/// hone runs on.
inline constexpr std::size_t kPageBytes = 4096;

/// `bytes` and what is left of their last page.
[[nodiscard]] constexpr std::size_t wholePages(std::size_t bytes) {
    return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
}

/// Gives out whole pages: what is allocated starts at one, and the rest of its last page belongs to
/// nobody, so that a device can use it in place. At least 16 bytes past the last element may be
/// read, as Embree does with vertices.
template <class T> struct PageAllocator {
    using value_type = T;

    PageAllocator() = default;
    template <class U> PageAllocator(const PageAllocator<U>&) noexcept {}

    [[nodiscard]] T* allocate(std::size_t count) {
        if (count > kMostBytes / sizeof(T))
            throw std::bad_array_new_length();
        const std::size_t bytes = wholePages(count * sizeof(T) + kReadable);
        return static_cast<T*>(::operator new (bytes, std::align_val_t{kPageBytes}));
    }
    void deallocate(T* first, std::size_t) noexcept {
        ::operator delete (first, std::align_val_t{kPageBytes});
    }
    friend bool operator==(const PageAllocator&, const PageAllocator&) { return true; }

private:
    static constexpr std::size_t kReadable = 16;
    /// No object is larger than pointers can be apart.
    static constexpr std::size_t kMostBytes =
        std::numeric_limits<std::ptrdiff_t>::max() - 2 * kPageBytes;
};

/// A vector whose elements a device can use where they are.
template <class T> using PagedVector = std::vector<T, PageAllocator<T>>;

} // namespace hone

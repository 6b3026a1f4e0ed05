// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/page_allocator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>

namespace hone {
namespace {

TEST(PagedVector, StartsAtAPageHoweverItGrew) {
    PagedVector<float> grown;
    for (int i = 0; i < 5000; ++i) {
        grown.push_back(static_cast<float>(i));
        ASSERT_EQ(reinterpret_cast<std::uintptr_t>(grown.data()) % kPageBytes, 0u) << i;
    }
    EXPECT_EQ(grown[4999], 4999.0f);
}

TEST(PagedVector, HasTheRestOfItsLastPageAndSixteenBytesToItself) {
    // Written whole, under the sanitizer also looked at: nobody else's bytes.
    for (const std::size_t count : {1u, 1023u, 1024u, 1025u}) {
        PagedVector<float> vector(count);
        const std::size_t bytes = count * sizeof(float);
        std::memset(static_cast<void*>(vector.data()), 0x55,
                    std::max(wholePages(bytes), bytes + 16));
    }
}

TEST(PagedVector, RefusesMoreThanThereCanBe) {
    PagedVector<double> vector;
    EXPECT_THROW(vector.reserve(vector.max_size() + 1), std::length_error);
    EXPECT_THROW(static_cast<void>(PageAllocator<double>().allocate(~std::size_t{0} / 8)),
                 std::bad_array_new_length);
}

TEST(WholePages, RoundUp) {
    EXPECT_EQ(wholePages(0), 0u);
    EXPECT_EQ(wholePages(1), kPageBytes);
    EXPECT_EQ(wholePages(kPageBytes), kPageBytes);
    EXPECT_EQ(wholePages(kPageBytes + 1), 2 * kPageBytes);
}

} // namespace
} // namespace hone

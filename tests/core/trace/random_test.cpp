// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/kernel.glsl.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace hone {
namespace {

struct Random : HostKernel {
    Random() : HostKernel(none, nullptr) {}
    Arguments none;
#include "hone/core/trace/random.glsl.h"
};

TEST(Random, DiffersWithEveryWordOfTheIndex) {
    Random random;
    std::set<uint> words;
    for (uint word = 0; word < 4; ++word)
        for (uint value = 1; value <= 1000; ++value) {
            uvec4 index(0);
            index[static_cast<int>(word)] = value;
            words.insert(random.pcg4d(index).x);
        }
    EXPECT_EQ(words.size(), 4000);
}

TEST(Random, FillsTheUnitIntervalEvenly) {
    Random random;
    std::array<uint, 16> counts{};
    constexpr uint kDraws = 16'000;
    for (uint i = 0; i < kDraws; ++i) {
        const float x = random.unitFloat(random.pcg4d(uvec4(i, 0, 0, 0)).y);
        ASSERT_GE(x, 0.0f);
        ASSERT_LT(x, 1.0f);
        ++counts[static_cast<std::size_t>(x * 16.0f)];
    }
    // A binomial count of mean 1000 has a deviation of 31; five of them are next to impossible.
    for (uint count : counts)
        EXPECT_NEAR(count, 1000, 155);
}

TEST(Random, MakesUnitFloatsBelowOne) {
    Random random;
    EXPECT_EQ(random.unitFloat(0u), 0.0f);
    EXPECT_LT(random.unitFloat(0xffffffffu), 1.0f);
}

} // namespace
} // namespace hone

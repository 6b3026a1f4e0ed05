// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/kernel.glsl.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace hone {
namespace {

struct Library : HostKernel {
    Library() : HostKernel(Arguments{}, nullptr) {}
#include "hone/core/trace/disc.glsl.h"

#include "hone/core/trace/random.glsl.h"
};

TEST(ScrambledSobol, BeginsAsTheSequenceDoes) {
    Library library;
    // (0, 0), (1/2, 1/2), (1/4, 3/4), (3/4, 1/4), (1/8, 5/8): digits mirrored at the point, and
    // those times Pascal's matrix modulo 2.
    const float expected[][2] = {
        {0, 0}, {0.5f, 0.5f}, {0.25f, 0.75f}, {0.75f, 0.25f}, {0.125f, 0.625f}};
    for (uint i = 0; i < 5; ++i) {
        const uvec2 bits = library.scrambledSobol(i, uvec2(0));
        EXPECT_EQ(library.unitFloat(bits.x), expected[i][0]) << i;
        EXPECT_EQ(library.unitFloat(bits.y), expected[i][1]) << i;
    }
}

TEST(ScrambledSobol, StratifiesEveryPowerOfTwoWhateverTheScramble) {
    Library library;
    for (const uvec2 scramble : {uvec2(0), uvec2(0xdeadbeef, 0x12345678)})
        for (uint first : {0u, 16u, 48u})
            for (const uint columns : {1u, 2u, 4u, 8u, 16u}) {
                std::set<std::pair<uint, uint>> cells;
                for (uint i = first; i < first + 16; ++i) {
                    const uvec2 bits = library.scrambledSobol(i, scramble);
                    const auto columns_f = static_cast<float>(columns);
                    cells.emplace(library.unitFloat(bits.x) * columns_f,
                                  library.unitFloat(bits.y) * (16 / columns_f));
                }
                EXPECT_EQ(cells.size(), 16u) << columns << " columns from " << first;
            }
}

TEST(DiscFromSquare, KeepsTheShareOfAreas) {
    // The squares of side s around the middle become discs of radius s.
    Library library;
    constexpr int kSteps = 64;
    for (int row = 0; row < kSteps; ++row)
        for (int column = 0; column < kSteps; ++column) {
            const vec2 square = 2.0f * vec2((static_cast<float>(column) + 0.5f) / kSteps,
                                            (static_cast<float>(row) + 0.5f) / kSteps) -
                                1.0f;
            EXPECT_NEAR(glm::length(library.discFromSquare(square)),
                        glm::max(glm::abs(square.x), glm::abs(square.y)), 1e-6f);
        }
    // Four sides to four quarters, and the middle stays.
    EXPECT_LT(glm::distance(library.discFromSquare({1, 0}), vec2(1, 0)), 1e-6f);
    EXPECT_LT(glm::distance(library.discFromSquare({0, 1}), vec2(0, 1)), 1e-6f);
    EXPECT_LT(glm::distance(library.discFromSquare({-1, 0}), vec2(-1, 0)), 1e-6f);
    EXPECT_LT(glm::distance(library.discFromSquare({0, -1}), vec2(0, -1)), 1e-6f);
    EXPECT_EQ(library.discFromSquare({0, 0}), vec2(0, 0));
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/error/dof/dilate.h"

#include <gtest/gtest.h>

#include <random>

namespace hone {
namespace {

struct Mask {
    uvec2 extent;
    std::vector<int> radius;
};

/// Sizes, densities and radii of all kinds, by seed.
Mask randomMask(unsigned seed) {
    std::mt19937 random(seed);
    Mask mask;
    mask.extent = {1 + random() % 67, 1 + random() % 53};
    const unsigned rarity = 1u << (random() % 9);
    const int largest = static_cast<int>(seed % 41); // 0..40
    for (uint i = 0; i < mask.extent.x * mask.extent.y; ++i)
        mask.radius.push_back(random() % rarity == 0
                                  ? static_cast<int>(random() % static_cast<unsigned>(largest + 1))
                                  : -1);
    return mask;
}

/// Tries every pair.
template <class Reaches> std::vector<std::uint8_t> bruteForce(const Mask& mask, Reaches reaches) {
    const int width = static_cast<int>(mask.extent.x), height = static_cast<int>(mask.extent.y);
    std::vector<std::uint8_t> grown(mask.radius.size(), 0);
    for (std::size_t q = 0; q < grown.size(); ++q) {
        const int r = mask.radius[q], qx = static_cast<int>(q) % width,
                  qy = static_cast<int>(q) / width;
        for (int y = std::max(qy - r, 0); y <= std::min(qy + r, height - 1); ++y)
            for (int x = std::max(qx - r, 0); x <= std::min(qx + r, width - 1); ++x)
                if (reaches(x - qx, y - qy, r))
                    grown[static_cast<std::size_t>(y * width + x)] = 1;
    }
    return grown;
}

TEST(Dilation, GrowsSquaresAsTryingEveryPairWould) {
    Dilation dilation;
    for (unsigned seed = 0; seed < 100; ++seed) {
        const Mask mask = randomMask(seed);
        std::vector<std::uint8_t> grown(mask.radius.size(), 7);
        dilation.squares(mask.extent, mask.radius, grown);
        EXPECT_EQ(grown, bruteForce(mask, [](int, int, int) { return true; })) << "seed " << seed;
    }
}

TEST(Dilation, GrowsDiscsAsTryingEveryPairWould) {
    Dilation dilation;
    for (unsigned seed = 0; seed < 100; ++seed) {
        const Mask mask = randomMask(seed);
        std::vector<std::uint8_t> grown(mask.radius.size(), 7);
        dilation.discs(mask.extent, mask.radius, grown);
        EXPECT_EQ(grown,
                  bruteForce(mask, [](int x, int y, int r) { return x * x + y * y <= r * r; }))
            << "seed " << seed;
    }
}

TEST(Dilation, OfNothingIsNothing) {
    Dilation dilation;
    const std::vector<int> radius(12, -1);
    std::vector<std::uint8_t> grown(12, 7);
    dilation.squares({4, 3}, radius, grown);
    EXPECT_EQ(grown, std::vector<std::uint8_t>(12, 0));
    grown.assign(12, 7);
    dilation.discs({4, 3}, radius, grown);
    EXPECT_EQ(grown, std::vector<std::uint8_t>(12, 0));
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/tile_order.h"

#include <gtest/gtest.h>

#include <vector>

namespace hone {
namespace {

std::vector<uint> all(const TileOrder& order) {
    std::vector<uint> pixels;
    for (uint tile = 0; tile < order.tiles().x * order.tiles().y; ++tile)
        order.forEachPixel(tile, [&](uint pixel) { pixels.push_back(pixel); });
    return pixels;
}

TEST(TileOrder, IsZOrderInsideATile) {
    // 4 x 2 pixels, x in the even bits: (0,0) (1,0) (0,1) (1,1) (2,0) (3,0) (2,1) (3,1).
    EXPECT_EQ(all(TileOrder({4, 2})), (std::vector<uint>{0, 1, 4, 5, 2, 3, 6, 7}));
}

TEST(TileOrder, VisitsTilesRowByRow) {
    const TileOrder order({TileOrder::kTile + 1, TileOrder::kTile + 1});
    const std::vector<uint> pixels = all(order);
    const uint width = TileOrder::kTile + 1;
    EXPECT_EQ(pixels.at(TileOrder::kTilePixels), TileOrder::kTile); // second tile: last column
    EXPECT_EQ(pixels.at(TileOrder::kTilePixels + TileOrder::kTile), TileOrder::kTile * width);
    EXPECT_EQ(pixels.back(), width * width - 1);
}

class TileOrderOfSize : public testing::TestWithParam<uvec2> {};

TEST_P(TileOrderOfSize, VisitsEveryPixelOnceWithGrowingKeysAndRanksWithoutGaps) {
    const uvec2 extent = GetParam();
    const TileOrder order(extent);
    const std::vector<uint> pixels = all(order);
    ASSERT_EQ(pixels.size(), std::size_t{extent.x} * extent.y);
    std::vector<bool> seen(pixels.size());
    std::vector<int> last_x(extent.y, -1);
    uint next_key = 0;
    for (uint rank = 0; rank < pixels.size(); ++rank) {
        const uint pixel = pixels[rank];
        ASSERT_FALSE(seen.at(pixel));
        seen[pixel] = true;
        ASSERT_GE(order.key(pixel), next_key);
        next_key = order.key(pixel) + 1;
        ASSERT_EQ(order.pixelOfKey(order.key(pixel)), pixel);
        const uint tile = order.tileOfRank(rank);
        ASSERT_LE(order.firstRank(tile), rank);
        ASSERT_GT(order.firstRank(tile + 1), rank);
        // Left to right along a row.
        const int x = static_cast<int>(pixel % extent.x);
        ASSERT_GT(x, last_x[pixel / extent.x]);
        last_x[pixel / extent.x] = x;
    }
    EXPECT_LE(next_key, order.keyCount());
}

INSTANTIATE_TEST_SUITE_P(Sizes, TileOrderOfSize,
                         testing::Values(uvec2(1, 1), uvec2(8, 8), uvec2(64, 64), uvec2(37, 21),
                                         uvec2(1, 100), uvec2(100, 1), uvec2(65, 97)),
                         [](const auto& tested) {
                             return std::to_string(tested.param.x) + "x" +
                                    std::to_string(tested.param.y);
                         });

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/mipmap.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

std::vector<std::uint8_t> bytes(const std::vector<uint>& texels) {
    std::vector<std::uint8_t> rgba;
    for (const uint texel : texels)
        for (uint shift = 0; shift < 32; shift += 8)
            rgba.push_back(static_cast<std::uint8_t>(texel >> shift));
    return rgba;
}

std::vector<uint> mipmapOf(uvec2 extent, const std::vector<uint>& texels) {
    return makeMipmap(extent, bytes(texels));
}

TEST(Mipmap, HalvesDownToOneTexel) {
    EXPECT_EQ(mipLevels({1, 1}), 1u);
    EXPECT_EQ(mipLevels({2, 1}), 2u);
    EXPECT_EQ(mipLevels({5, 3}), 3u); // 5x3, 2x1, 1x1
    EXPECT_EQ(mipLevels({512, 512}), 10u);
    EXPECT_EQ(mipmapOf({5, 3}, std::vector<uint>(15, 0xff336699u)),
              std::vector<uint>(15 + 2 + 1, 0xff336699u));
}

TEST(Mipmap, AveragesColourInLinearLight) {
    // Linear 0.75 is 1.055 * 0.75^(1/2.4) - 0.055 = 0.8808, code 224.6; 0.5 is 187.5; 0.25 is
    // 137.0.
    const std::vector<uint> texels =
        mipmapOf({2, 2}, {0xffffffffu, 0xff00ffffu, 0xff0000ffu, 0xff000000u});
    ASSERT_EQ(texels.size(), 5u);
    EXPECT_EQ(texels[4] & 255u, 225u);
    EXPECT_EQ(texels[4] >> 8 & 255u, 188u);
    EXPECT_EQ(texels[4] >> 16 & 255u, 137u);
}

TEST(Mipmap, AveragesAlphaAsItIs) {
    const std::vector<uint> texels =
        mipmapOf({2, 2}, {0x10000000u, 0x20000000u, 0x30000000u, 0x40000000u});
    EXPECT_EQ(texels[4] >> 24, 0x28u);
}

TEST(Mipmap, HolesLendNoColour) {
    EXPECT_EQ(mipmapOf({2, 1}, {0xff0000ffu, 0x00ff0000u}).back(), 0x800000ffu);
    // Nothing but holes: their colour is all there is.
    EXPECT_EQ(mipmapOf({2, 1}, {0x000000ffu, 0x000000ffu}).back(), 0x000000ffu);
}

TEST(Mipmap, AllCodesSurviveAveraging) {
    for (uint code = 0; code < 256; ++code) {
        const uint texel = code | code << 8 | code << 16 | code << 24;
        EXPECT_EQ(mipmapOf({2, 1}, {texel, texel}).back(), texel);
    }
}

TEST(Mipmap, LevelsFollowEachOtherInTheScene) {
    Scene scene;
    scene.texels = {1, 2, 3};
    EXPECT_EQ(appendTexture(scene, {2, 2}, bytes({1, 2, 3, 4}), 1, 2), 0u);
    const Texture& texture = scene.textures[0];
    EXPECT_EQ(texture.first_texel, 3u);
    EXPECT_EQ(uvec3(texture.width, texture.height, texture.levels), uvec3(2, 2, 2));
    EXPECT_EQ(texture.wrap_u, 1u);
    EXPECT_EQ(texture.wrap_v, 2u);
    EXPECT_EQ(scene.texels.size(), 3u + 4 + 1);
}

} // namespace
} // namespace hone

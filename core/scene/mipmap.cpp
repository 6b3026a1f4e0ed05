// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/mipmap.h"

#include "hone/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hone {
namespace {

/// The sRGB transfer function (IEC 61966-2-1) both ways, as tables: 2^16 steps of linear light are
/// finer than any two neighbouring codes are apart.
class SrgbTables {
public:
    SrgbTables() {
        for (std::size_t code = 0; code < decoded_.size(); ++code) {
            const double encoded = static_cast<double>(code) / 255.0;
            decoded_[code] = static_cast<float>(
                encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
        }
        for (std::size_t step = 0; step < encoded_.size(); ++step) {
            const double linear = static_cast<double>(step) / kSteps;
            const double encoded =
                linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
            encoded_[step] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
        }
    }
    [[nodiscard]] float decode(uint code) const { return decoded_[code]; }
    [[nodiscard]] uint encode(float linear) const {
        return encoded_[static_cast<std::size_t>(std::min(linear, 1.0f) * kSteps + 0.5f)];
    }

private:
    static constexpr std::size_t kSteps = 65535;
    std::array<float, 256> decoded_{};
    std::array<std::uint8_t, kSteps + 1> encoded_{};
};

const SrgbTables& srgb() {
    static const SrgbTables kTables;
    return kTables;
}

struct Level {
    uvec2 extent;
    std::vector<vec4> texels; ///< linear colour, not multiplied by alpha; alpha from 0 to 255
};

/// The mean of the 2 x 2 texels above each. The last row and column of odd sides are left out, as
/// sizes round down; a side of 1 counts twice.
Level halved(const Level& fine) {
    Level coarse{{std::max(1u, fine.extent.x / 2), std::max(1u, fine.extent.y / 2)}, {}};
    coarse.texels.reserve(std::size_t{coarse.extent.x} * coarse.extent.y);
    for (uint y = 0; y < coarse.extent.y; ++y)
        for (uint x = 0; x < coarse.extent.x; ++x) {
            vec3 weighted(0);
            vec3 plain(0);
            float alpha = 0;
            for (uint corner = 0; corner < 4; ++corner) {
                const uint fx = std::min(2 * x + (corner & 1u), fine.extent.x - 1);
                const uint fy = std::min(2 * y + (corner >> 1u), fine.extent.y - 1);
                const vec4 texel = fine.texels[std::size_t{fy} * fine.extent.x + fx];
                weighted += texel.w * vec3(texel);
                plain += vec3(texel);
                alpha += texel.w;
            }
            const vec3 color = alpha > 0.0f ? weighted / alpha : plain * 0.25f;
            coarse.texels.emplace_back(color, alpha * 0.25f);
        }
    return coarse;
}

uint packed(vec4 texel) {
    return srgb().encode(texel.x) | srgb().encode(texel.y) << 8 | srgb().encode(texel.z) << 16 |
           static_cast<uint>(texel.w + 0.5f) << 24;
}

} // namespace

uint mipLevels(uvec2 extent) {
    uint levels = 1;
    for (uint side = std::max(extent.x, extent.y); side > 1; side /= 2)
        ++levels;
    return levels;
}

std::vector<uint> makeMipmap(uvec2 extent, std::span<const std::uint8_t> rgba) {
    const std::size_t count = std::size_t{extent.x} * extent.y;
    HONE_ASSERT(count > 0 && rgba.size() == 4 * count, std::to_string(rgba.size()));
    std::vector<uint> mipmap;
    mipmap.reserve(count + count / 3 + mipLevels(extent));
    Level level{extent, {}};
    level.texels.reserve(count);
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        mipmap.push_back(rgba[i] | uint{rgba[i + 1]} << 8 | uint{rgba[i + 2]} << 16 |
                         uint{rgba[i + 3]} << 24);
        level.texels.emplace_back(srgb().decode(rgba[i]), srgb().decode(rgba[i + 1]),
                                  srgb().decode(rgba[i + 2]), rgba[i + 3]);
    }
    // Halve what was averaged, not what was rounded to codes.
    while (level.extent != uvec2(1, 1)) {
        level = halved(level);
        std::ranges::transform(level.texels, std::back_inserter(mipmap), packed);
    }
    return mipmap;
}

uint appendTexture(Scene& scene, uvec2 extent, std::span<const std::uint8_t> rgba, uint wrap_u,
                   uint wrap_v) {
    const std::vector<uint> mipmap = makeMipmap(extent, rgba);
    scene.textures.push_back({static_cast<uint>(scene.texels.size()), extent.x, extent.y,
                              mipLevels(extent), wrap_u, wrap_v});
    scene.texels.insert(scene.texels.end(), mipmap.begin(), mipmap.end());
    return static_cast<uint>(scene.textures.size() - 1);
}

} // namespace hone

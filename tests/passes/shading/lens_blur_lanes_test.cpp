// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/lens_blur_lanes.h"

#include "hone/core/device/kernel.glsl.h"
#include "hone/passes/shading/lens_blur.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace hone {
namespace {

/// Pixel by pixel.
struct OneByOne : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/depth_of_field/depth_of_field.glsl.h"
};

template <class T> BufferView viewOf(std::vector<T>& values) {
    return {0, 0, values.size() * sizeof(T), reinterpret_cast<std::byte*>(values.data())};
}

/// An image with jumps of blur, slopes and single pixels of another depth.
struct Frame {
    uvec2 extent;
    float radius_limit;
    std::vector<float> confusion, reach;
    std::vector<vec3> image;

    Frame(uvec2 size, float limit, uint seed) : extent(size), radius_limit(limit) {
        std::mt19937 random(seed);
        const auto number = [&] { return static_cast<float>(random() % 1000) / 1000; };
        for (uint i = 0; i < extent.x * extent.y; ++i) {
            const auto x = static_cast<float>(i % extent.x), y = static_cast<float>(i / extent.x);
            float diameter = x > y ? 0.3f * x - 6 : 0;
            if (random() % 17 == 0)
                diameter = 60 * number() - 30;
            confusion.push_back(diameter);
            image.emplace_back(number(), number(), number());
        }
        findReach();
    }

    [[nodiscard]] float radius(uint pixel) const {
        return std::clamp(0.5f * std::abs(confusion[pixel]), 0.5f, radius_limit);
    }

    /// The greatest radius of the pixels whose discs touch each tile's.
    void findReach() {
        const uvec2 tiles = LensBlur::tiles(extent);
        for (uint tile = 0; tile < tiles.x * tiles.y; ++tile) {
            const uvec2 first = LensBlur::kTile * uvec2(tile % tiles.x, tile / tiles.x);
            const uvec2 last = min(first + LensBlur::kTile, extent) - 1u;
            float greatest = 0;
            for (uint pixel = 0; pixel < extent.x * extent.y; ++pixel) {
                const uvec2 at(pixel % extent.x, pixel / extent.x);
                const vec2 off = vec2(at) - vec2(clamp(at, first, last));
                if (glm::length(off) < radius(pixel) + 0.5f)
                    greatest = std::max(greatest, radius(pixel));
            }
            reach.push_back(greatest);
        }
    }

    [[nodiscard]] std::vector<vec3> oneByOne(uint taps) {
        std::vector<vec3> blurred(image.size());
        Arguments arguments;
        arguments.bind("image", viewOf(image));
        arguments.bind("color", viewOf(blurred));
        arguments.bind("confusion", viewOf(confusion));
        arguments.bind("blur_reach", viewOf(reach));
        const OneByOne::Params params{extent, taps, radius_limit};
        OneByOne kernel(arguments, &params);
        for (uint pixel = 0; pixel < image.size(); ++pixel)
            kernel.kernel(pixel);
        return blurred;
    }
    [[nodiscard]] LensBlurLanes::Frame lanes(uint taps) {
        return {extent, taps, radius_limit, viewOf(confusion), viewOf(reach)};
    }
    [[nodiscard]] std::vector<vec3> inLanes(uint taps) {
        std::vector<vec3> blurred(image.size(), vec3(-1));
        LensBlurLanes().blur(lanes(taps), image, blurred);
        return blurred;
    }
};

bool isSame(float a, float b) {
    return std::bit_cast<uint>(a) == std::bit_cast<uint>(b) || (std::isnan(a) && std::isnan(b));
}

void expectSameBits(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(isSame(a[i][c], b[i][c]))
                << "pixel " << i << ": " << a[i][c] << ", " << b[i][c];
}

TEST(LensBlurLanes, HaveTheBitsOfOnePixelAfterTheOther) {
    uint seed = 0;
    for (const uvec2 extent : {uvec2(1, 1), uvec2(5, 3), uvec2(1, 40), uvec2(40, 1), uvec2(16, 16),
                               uvec2(33, 50), uvec2(70, 64)})
        for (const uint taps : {0u, 1u, 49u, 441u})
            for (const float limit : {0.5f, 7.25f, 20.0f}) {
                SCOPED_TRACE(std::to_string(extent.x) + "x" + std::to_string(extent.y) + ", taps " +
                             std::to_string(taps) + ", limit " + std::to_string(limit));
                Frame frame(extent, limit, ++seed);
                expectSameBits(frame.oneByOne(taps), frame.inLanes(taps));
            }
}

TEST(LensBlurLanes, SpreadWhatIsNotFiniteNoFurther) {
    Frame frame({50, 40}, 20, 99);
    frame.image[17 * 50 + 20] = vec3(std::numeric_limits<float>::infinity());
    frame.image[30 * 50 + 3] = vec3(std::numeric_limits<float>::quiet_NaN());
    expectSameBits(frame.oneByOne(0), frame.inLanes(0));
}

TEST(LensBlurLanes, BlurTwoChannelsAsTheyBlurThree) {
    Frame frame({50, 40}, 20, 7);
    std::vector<vec2> errors, blurred(frame.image.size());
    for (const vec3& color : frame.image)
        errors.emplace_back(color.x, color.y);
    LensBlurLanes().blur(frame.lanes(49), errors, blurred);
    const std::vector<vec3> all = frame.inLanes(49);
    for (std::size_t i = 0; i < all.size(); ++i)
        ASSERT_EQ(blurred[i], vec2(all[i].x, all[i].y)) << i;
}

TEST(LensBlurLanes, LeaveTilesThatNobodyWantsAtZero) {
    Frame frame({50, 40}, 20, 8); // 4 x 3 tiles
    std::vector<uint> wanted(12, 0);
    wanted[5] = 1;
    LensBlurLanes::Frame some = frame.lanes(0);
    some.wanted = wanted;
    std::vector<vec3> blurred(frame.image.size(), vec3(-1));
    LensBlurLanes().blur(some, frame.image, blurred);
    const std::vector<vec3> all = frame.inLanes(0);
    for (uint i = 0; i < all.size(); ++i) {
        const bool is_inside = i % 50 / 16 == 1 && i / 50 / 16 == 1;
        ASSERT_EQ(blurred[i], is_inside ? all[i] : vec3(0)) << i;
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/kernel.glsl.h"
#include "hone/tests/support/lens_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hone {
namespace {

struct Library : HostKernel {
    Library() : HostKernel(Arguments{}, nullptr) {}
#include "hone/core/scene/camera.glsl.h"
};

/// A lens of diameter 0.5 m whose focal length is 130 pixels, focused at 6 m.
constexpr uvec2 kExtent{160, 130};
const Camera kLens = test::lensCamera(0.5f, 6);

TEST(CircleOfConfusion, IsThatOfThinLenses) {
    Library library;
    const auto diameter = [&](float depth) {
        return library.circleOfConfusion(kLens, kExtent, depth);
    };
    // 0.5 * 130 * (1 / 6 - 1 / depth)
    EXPECT_NEAR(diameter(12), 5.41667f, 1e-5f);
    EXPECT_NEAR(diameter(6), 0.0f, 1e-5f);
    EXPECT_NEAR(diameter(3), -10.8333f, 1e-4f);
    EXPECT_NEAR(diameter(2), -21.6667f, 1e-4f);
    EXPECT_NEAR(diameter(1e30f), 10.8333f, 1e-4f);
    EXPECT_EQ(diameter(0), diameter(1e30f)) << "what sees nothing is infinitely far";
}

// Potmesil and Chakravarty's own form: V_U = F U / (U - F), C = |V_U - V_P| F / (n V_U), a length
// on a sensor at V_P.
TEST(CircleOfConfusion, IsThatOfALensWithAFocalLength) {
    Library library;
    const double focal_length = 0.05, f_number = 0.1, focus = 6;
    const double sensor = focal_length * focus / (focus - focal_length);
    EXPECT_NEAR(sensor, 0.0504202, 1e-7);
    for (const double depth : {0.5, 2.0, 3.0, 12.0, 1000.0}) {
        const double image = focal_length * depth / (depth - focal_length);
        const double length = std::abs(image - sensor) * focal_length / (f_number * image);
        const double pixels = length * 130 / sensor; // 130 pixels are the sensor's distance
        EXPECT_NEAR(std::abs(library.circleOfConfusion(kLens, kExtent, static_cast<float>(depth))),
                    pixels, 1e-5 * pixels);
    }
    // Its limit is |F - V_P| / n.
    EXPECT_NEAR((sensor - focal_length) / f_number * 130 / sensor,
                library.circleOfConfusion(kLens, kExtent, 0), 1e-4);
}

TEST(CircleOfConfusion, IsThatOfAPhotographersLens) {
    // 50 mm f/2 focused at 3 m, a sensor of 36 mm in 1920 x 1080 pixels: 22.599 pixels at infinity.
    const float sensor_distance = 0.05f * 3 / (3 - 0.05f);
    Camera camera = test::lensCamera(0.05f / 2, 3);
    camera.tan_half_fov_y = 0.5f * 0.036f * 1080 / 1920 / sensor_distance;
    Library library;
    EXPECT_NEAR(library.circleOfConfusion(camera, {1920, 1080}, 0), 22.599f, 1e-3f);
}

TEST(CircleOfConfusion, IsFiniteHoweverNearTheDepth) {
    Library library;
    constexpr float kLeast = std::numeric_limits<float>::denorm_min();
    for (const float depth : {kLeast, std::numeric_limits<float>::min(), 1e-12f}) {
        const float diameter = library.circleOfConfusion(kLens, kExtent, depth);
        EXPECT_LT(diameter, 0.0f);
        EXPECT_TRUE(std::isfinite(diameter * diameter)) << depth;
    }
}

TEST(LensRay, ThroughTheCentreIsTheCamerasRay) {
    Library library;
    const vec2 position(17.5f, 99.5f);
    const Ray pinhole = library.cameraRay(kLens, kExtent, position);
    const Ray ray = library.lensRay(kLens, kExtent, position, vec2(0));
    EXPECT_EQ(ray.origin, pinhole.origin);
    EXPECT_EQ(ray.direction, pinhole.direction);
    EXPECT_EQ(ray.tmin, pinhole.tmin);
    EXPECT_EQ(ray.tmax, pinhole.tmax);
}

TEST(LensRay, MeetsTheOthersInThePlaneOfFocusAndKeepsTheViewDepth) {
    Library library;
    const vec2 position(17.5f, 99.5f);
    const Ray pinhole = library.cameraRay(kLens, kExtent, position);
    for (const vec2 lens : {vec2(1, 0), vec2(0, 1), vec2(-0.6f, 0.8f), vec2(0.3f, -0.2f)}) {
        const Ray ray = library.lensRay(kLens, kExtent, position, lens);
        EXPECT_LT(glm::distance(ray.origin, 0.25f * vec3(lens.x, lens.y, 0)), 1e-6f);
        EXPECT_EQ(glm::dot(ray.direction, kLens.forward), 1.0f);
        EXPECT_LT(glm::distance(ray.origin + 6.0f * ray.direction, 6.0f * pinhole.direction),
                  1e-5f);
    }
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/camera_path.h"

#include "hone/core/error.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

CameraKey key(float time, vec3 position, float aperture = 0) {
    return {time,
            {.name = "path",
             .position = position,
             .target = position + vec3(0, 0, -1),
             .fov_y_degrees = 40 + 10 * time,
             .aperture = aperture,
             .focus = 1 + time}};
}

TEST(CameraPath, PassesItsKeysExactly) {
    const CameraPath path{
        "path", {key(0, {0.1f, 0, 0}), key(0.3f, {1, 0.7f, 0}), key(1, {3, 0, 0.9f}, 0.3f)}};
    for (const CameraKey& at : path.keys) {
        const CameraDesc camera = cameraAt(path, at.time);
        EXPECT_EQ(camera.position, at.camera.position);
        EXPECT_EQ(camera.target, at.camera.target);
        EXPECT_EQ(camera.focus, at.camera.focus);
        EXPECT_EQ(camera.aperture, at.camera.aperture);
    }
}

TEST(CameraPath, IsStraightAndEvenBetweenTwoKeys) {
    // Both speeds are the mean speed, so the cubic is a line.
    const CameraPath path{"path", {key(1, {0, 0, 0}), key(3, {4, 8, 0}, 0.5f)}};
    const CameraDesc camera = cameraAt(path, 1.5f);
    EXPECT_NEAR(glm::distance(camera.position, vec3(1, 2, 0)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(camera.target, vec3(1, 2, -1)), 0.0f, 1e-6f);
    EXPECT_FLOAT_EQ(camera.aperture, 0.125f);
    EXPECT_FLOAT_EQ(camera.focus, 2.5f);
    EXPECT_FLOAT_EQ(camera.fov_y_degrees, 55.0f);
}

TEST(CameraPath, IsTheCatmullRomSplineBetweenEvenKeys) {
    // Half way between b and c of even keys a b c d: (9 (b + c) - (a + d)) / 16.
    const CameraPath path{
        "path", {key(0, {0, 0, 0}), key(1, {1, 2, 0}), key(2, {3, 2, 1}), key(3, {9, 0, 0})}};
    const vec3 expected = (9.0f * vec3(4, 4, 1) - vec3(9, 0, 0)) / 16.0f;
    EXPECT_NEAR(glm::distance(cameraAt(path, 1.5f).position, expected), 0.0f, 1e-6f);
}

TEST(CameraPath, HoldsItsEnds) {
    const CameraPath path{"path", {key(1, {1, 0, 0}), key(2, {2, 0, 0})}};
    EXPECT_EQ(cameraAt(path, -5).position, vec3(1, 0, 0));
    EXPECT_EQ(cameraAt(path, 50).position, vec3(2, 0, 0));
    EXPECT_EQ(cameraAt({"path", {key(1, {1, 0, 0})}}, 7).position, vec3(1, 0, 0));
}

TEST(CameraPath, FramesReachFromTheFirstKeyToTheLast) {
    const CameraPath path{"path", {key(1, {1, 0, 0}), key(4, {2, 0, 0})}};
    EXPECT_EQ(frameTime(path, 0, 1), 1.0f);
    EXPECT_EQ(frameTime(path, 0, 4), 1.0f);
    EXPECT_EQ(frameTime(path, 2, 4), 3.0f);
    EXPECT_EQ(frameTime(path, 3, 4), 4.0f);
}

TEST(CameraPath, OfASceneWithoutAnyGoesAroundTheTarget) {
    Scene scene;
    scene.name = "s";
    scene.cameras = {{.name = "a", .position = {3, 2, 0}, .target = {0, 1, 0}}};
    const CameraPath path = cameraPath(scene, "");
    EXPECT_EQ(path.name, "orbit");
    EXPECT_EQ(path.keys.front().camera.position, vec3(3, 2, 0));
    EXPECT_EQ(path.keys.back().camera.position, vec3(3, 2, 0));
    for (const CameraKey& at : path.keys) {
        EXPECT_NEAR(glm::distance(at.camera.position, vec3(0, 2, 0)), 3.0f, 1e-5f);
        EXPECT_EQ(at.camera.target, vec3(0, 1, 0));
    }
    EXPECT_NEAR(glm::distance(cameraAt(path, 4).position, vec3(-3, 2, 0)), 0.0f, 1e-5f);
}

TEST(CameraPath, IsFoundByItsNameOrTheNamesAreListed) {
    Scene scene;
    scene.name = "s";
    scene.paths = {{"walk", {key(0, {0, 0, 0})}}, {"fly", {key(0, {5, 0, 0})}}};
    EXPECT_EQ(cameraPath(scene, "").name, "walk");
    EXPECT_EQ(cameraPath(scene, "fly").name, "fly");
    try {
        (void)cameraPath(scene, "swim");
        FAIL() << "found what is not there";
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(), "s has no camera path \"swim\"; it has walk, fly");
    }
}

TEST(CameraPath, OfTheAtriumHasCamerasAtAllTimes) {
    const CameraPath path = cameraPath(loadScene("builtin:atrium"), "walk");
    for (uint frame = 0; frame < 50; ++frame)
        EXPECT_NO_THROW((void)makeCamera(cameraAt(path, frameTime(path, frame, 50))));
}

} // namespace
} // namespace hone

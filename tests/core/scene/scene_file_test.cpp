// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/core/scene/small_gltf.h"

#include <cmath>

namespace hone {
namespace {

/// The small square as model/square.gltf, with a mirror material and one node, and a scene file.
class SceneFile : public testing::Test {
protected:
    SceneFile() {
        folder.write("model/square.bin", model.binary);
        folder.write("model/square.gltf", model.json.dump());
    }
    Scene load(const std::string& text) const {
        return loadScene(folder.write("scenes/test.scene.json", text));
    }
    std::string error(const std::string& text) const {
        return loadError(folder.write("scenes/test.scene.json", text));
    }
    void expectError(const std::string& text, const std::string& words) const {
        const std::string what = error(text);
        EXPECT_NE(what.find("test.scene.json"), std::string::npos) << what;
        EXPECT_NE(what.find(words), std::string::npos) << what << "\nlacks: " << words;
    }

    SmallGltf model;
    ScratchFolder folder;
};

TEST_F(SceneFile, NamesAModelOutsideItsFolderAndMayHaveComments) {
    const Scene scene = load("// The user's own file may point anywhere.\n"
                             "{ \"model\": \"../model/square.gltf\" } // end");
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_TRUE(scene.name.ends_with("test.scene.json"));
}

TEST_F(SceneFile, CamerasComeBeforeTheModelsAndHaveDefaults) {
    const Scene scene = load(R"({"cameras": [
        {"name": "a", "position": [1, 2, 3], "target": [0, 0, 0]},
        {"name": "b", "position": [0, 0, 5], "target": [0, 0, 0], "up": [1, 0, 0], "fov_y": 30,
         "near": 0.5}]})");
    EXPECT_EQ(scene.camera("").name, "a");
    EXPECT_EQ(scene.camera("a").up, vec3(0, 1, 0));
    EXPECT_EQ(scene.camera("a").fov_y_degrees, 60.0f);
    EXPECT_EQ(scene.camera("b").up, vec3(1, 0, 0));
    EXPECT_EQ(scene.camera("b").fov_y_degrees, 30.0f);
    EXPECT_EQ(scene.camera("b").near, 0.5f);
}

TEST_F(SceneFile, ReadsAllKindsOfLight) {
    const Scene scene = load(R"({"lights": [
        {"type": "point", "position": [1, 2, 3], "intensity": 5, "range": 9},
        {"type": "spot", "position": [0, 1, 0], "direction": [0, -2, 0], "intensity": [1, 2, 3],
         "inner": 0, "outer": 60},
        {"type": "directional", "direction": [3, 0, 4], "irradiance": 2},
        {"type": "rectangle", "center": [0, 4, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, 6],
         "radiance": [10, 9, 8]}]})");
    ASSERT_EQ(scene.lights.size(), 4u);
    EXPECT_EQ(scene.lights[0].kind, kLightPoint);
    EXPECT_EQ(scene.lights[0].intensity, vec3(5));
    EXPECT_EQ(scene.lights[0].range, 9.0f);
    EXPECT_EQ(scene.lights[1].kind, kLightSpot);
    EXPECT_EQ(scene.lights[1].direction, vec3(0, -1, 0));
    EXPECT_NEAR(scene.lights[1].cos_outer, 0.5f, 1e-6f);
    EXPECT_EQ(scene.lights[1].cos_inner, 1.0f);
    EXPECT_EQ(scene.lights[2].kind, kLightDirectional);
    EXPECT_NEAR(scene.lights[2].direction.x, 0.6f, 1e-6f);
    EXPECT_EQ(scene.lights[3].kind, kLightRectangle);
    EXPECT_EQ(scene.lights[3].half_u, vec3(1, 0, 0));
    EXPECT_EQ(scene.lights[3].half_v, vec3(0, 0, 3));
    EXPECT_EQ(scene.lights[3].direction, vec3(0, -1, 0)); // x cross z
    EXPECT_EQ(scene.lights[3].intensity, vec3(10, 9, 8));
}

TEST_F(SceneFile, ReadsLightsWithAnExtentAndLightsWithoutShadows) {
    const Scene scene = load(R"({"lights": [
        {"type": "disc", "center": [0, 4, 0], "direction": [0, -3, 0], "radius": 2, "radiance": 5},
        {"type": "sphere", "center": [1, 2, 3], "radius": 0.5, "radiance": [1, 2, 3]},
        {"type": "directional", "direction": [0, -1, 0], "irradiance": 2, "angle": 90,
         "casts_shadow": false},
        {"type": "point", "position": [0, 1, 0], "intensity": 1, "casts_shadow": true}]})");
    ASSERT_EQ(scene.lights.size(), 4u);
    const Light& disc = scene.lights[0];
    EXPECT_EQ(disc.kind, kLightDisc);
    EXPECT_EQ(disc.direction, vec3(0, -1, 0));
    EXPECT_NEAR(glm::length(disc.half_u), 2.0f, 1e-6f);
    EXPECT_NEAR(glm::length(disc.half_v), 2.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(disc.half_u, disc.half_v), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(glm::cross(disc.half_u, disc.half_v), disc.direction), 4.0f, 1e-5f);
    EXPECT_EQ(scene.lights[1].kind, kLightSphere);
    EXPECT_EQ(scene.lights[1].radius, 0.5f);
    EXPECT_EQ(scene.lights[1].intensity, vec3(1, 2, 3));
    EXPECT_NEAR(scene.lights[2].radius, 1.0f, 1e-6f); // tan 45 degrees
    EXPECT_EQ(scene.lights[2].shadowless, 1u);
    EXPECT_EQ(scene.lights[3].shadowless, 0u);
}

TEST_F(SceneFile, ReadsALensByItsApertureOrItsFNumber) {
    const Scene scene = load(R"({"cameras": [
        {"name": "pinhole", "position": [0, 0, 5], "target": [0, 0, 0]},
        {"name": "wide", "position": [0, 0, 5], "target": [0, 0, 0],
         "lens": {"aperture": 0.5, "focus": 6}},
        {"name": "photo", "position": [0, 0, 5], "target": [0, 0, 0],
         "lens": {"focal_length": 0.05, "f_number": 2, "focus": 3}}]})");
    EXPECT_EQ(scene.camera("pinhole").aperture, 0.0f);
    EXPECT_EQ(scene.camera("wide").aperture, 0.5f);
    EXPECT_EQ(scene.camera("wide").focus, 6.0f);
    EXPECT_NEAR(scene.camera("photo").aperture, 0.025f, 1e-7f);
    EXPECT_EQ(makeCamera(scene.camera("wide")).lens_radius, 0.25f);
}

TEST_F(SceneFile, RefusesALensThatSaysTooMuchOrTooLittle) {
    const auto lens = [&](const std::string& members) {
        return R"({"cameras": [{"name": "a", "position": [0, 0, 5], "target": [0, 0, 0], "lens": {)" +
               members + "}}]}";
    };
    expectError(lens(R"("focus": 3)"), "/cameras/0/lens: expected either \"aperture\"");
    expectError(lens(R"("focus": 3, "aperture": 1, "f_number": 2)"), "expected either");
    expectError(lens(R"("focus": 3, "aperture": 1, "focal_length": 2)"), "belongs to");
    expectError(lens(R"("focus": 3, "f_number": 0, "focal_length": 2)"), "expected more");
    expectError(lens(R"("focus": 0.04, "f_number": 2, "focal_length": 0.05)"), "focal length");
    expectError(lens(R"("focus": 0, "aperture": 1)"), "expected more than 0");
}

TEST_F(SceneFile, NamesTheObjectsOfATask) {
    const Scene scene = load(R"({"model": "builtin:planar_mirror", "task_objects": ["mirror"]})");
    ASSERT_EQ(scene.task_objects.size(), 1u);
    EXPECT_EQ(scene.instance_names[scene.task_objects[0]], "mirror");
    expectError(R"({"model": "builtin:planar_mirror", "task_objects": ["mirrow"]})",
                "/task_objects/0: no instance is called \"mirrow\". Did you mean \"mirror\"?");
    expectError(R"({"task_objects": [3]})", "/task_objects/0: expected the name");
}

TEST_F(SceneFile, ReadsCameraPaths) {
    const Scene scene = load(R"({"paths": [
        {"name": "still", "keys": [{"time": -1, "position": [0, 0, 5], "target": [0, 0, 0]}]},
        {"name": "fly\u001b", "keys": [
            {"time": 0, "position": [0, 0, 5], "target": [0, 0, 0]},
            {"time": 2.5, "position": [0, 1, 5], "target": [0, 0, 0], "fov_y": 30,
             "lens": {"aperture": 0.5, "focus": 6}}]}]})");
    ASSERT_EQ(scene.paths.size(), 2u);
    EXPECT_EQ(scene.paths[0].keys[0].time, -1.0f);
    EXPECT_EQ(scene.paths[1].name.find('\x1b'), std::string::npos) << "names are untrusted";
    EXPECT_EQ(scene.paths[1].keys[1].time, 2.5f);
    EXPECT_EQ(scene.paths[1].keys[1].camera.position, vec3(0, 1, 5));
    EXPECT_EQ(scene.paths[1].keys[1].camera.fov_y_degrees, 30.0f);
    EXPECT_EQ(scene.paths[1].keys[1].camera.aperture, 0.5f);
}

TEST_F(SceneFile, RefusesCameraPathsThatLeadNowhere) {
    const auto path = [](const std::string& members) {
        return R"({"paths": [{"name": "a")" + members + "}]}";
    };
    const std::string view = R"("position": [0, 0, 5], "target": [0, 0, 0])";
    expectError(path(""), "/paths/0: expected \"keys\"");
    expectError(path(R"(, "keys": [])"), "/paths/0: expected \"keys\"");
    expectError(path(R"(, "keys": [{)" + view + "}]"), "/paths/0/keys/0: has no \"time\"");
    expectError(path(R"(, "keys": [{"time": 1, )" + view + R"(}, {"time": 1, )" + view + "}]"),
                "/paths/0/keys/1/time: not later than the key before");
    expectError(path(R"(, "keys": [{"time": 1, "name": "b", )" + view + "}]"), "unknown key");
    expectError(path(R"(, "keys": [{"time": 1, "position": [0, 0, 0], "target": [0, 0, 0]}])"),
                "/paths/0/keys/0: camera \"a\": position and target");
}

TEST_F(SceneFile, ReadsTheEnvironmentAndThenAddsNoSun) {
    const Scene scene =
        load(R"({"environment": {"zenith": [0, 0, 1], "horizon": 0.5, "ambient": 0.25}})");
    EXPECT_EQ(scene.environment.zenith, vec3(0, 0, 1));
    EXPECT_EQ(scene.environment.horizon, vec3(0.5f));
    EXPECT_EQ(scene.environment.ground, vec3(0));
    EXPECT_EQ(scene.environment.ambient, vec3(0.25f));
    EXPECT_TRUE(scene.lights.empty());
}

TEST_F(SceneFile, ChangesMaterialsAndGivesMirrorsTheirProbe) {
    const Scene scene = load(R"({"model": "../model/square.gltf",
        "materials": {"paint": {"mirror": 0.9, "base_color": 0, "emission": [1, 2, 3],
                                "two_sided": true}},
        "probes": [{"position": [7, 0, 0]}, {"position": [9, 8, 7], "object": "square"}]})");
    EXPECT_EQ(scene.materials[0].flags, kMaterialMirror | kMaterialTwoSided);
    EXPECT_EQ(scene.materials[0].f0, vec3(0.9f));
    EXPECT_EQ(scene.materials[0].base_color, vec3(0));
    EXPECT_EQ(scene.materials[0].emission, vec3(1, 2, 3));
    ASSERT_EQ(scene.probes.size(), 2u);
    EXPECT_EQ(scene.probes[0].object, kNone);
    EXPECT_EQ(scene.instances[0].probe, 1u);
}

TEST_F(SceneFile, MirrorZeroTakesAMirrorAway) {
    model.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0;
    folder.write("model/square.gltf", model.json.dump());
    const Scene scene =
        load(R"({"model": "../model/square.gltf", "materials": {"paint": {"mirror": 0}}})");
    EXPECT_EQ(scene.materials[0].flags, 0u);
    EXPECT_EQ(scene.instances[0].probe, kNone);
}

TEST_F(SceneFile, BadJsonIsNamedWithLineAndColumn) {
    expectError("{\n  \"cameras\": [,]\n}", "test.scene.json:2:15: ");
    expectError("", "test.scene.json:1:1: ");
}

TEST_F(SceneFile, UnknownKeysAreRefusedWithTheNearest) {
    expectError(R"({"camera": []})", "/camera: unknown key \"camera\". Did you mean \"cameras\"?");
    expectError(
        R"({"lights": [{"type": "point", "position": [0,0,0], "intensity": 1, "rang": 2}]})",
        "/lights/0/rang: unknown key \"rang\". Did you mean \"range\"?");
    expectError(R"({"lights": [{"type": "rectangle", "intensity": 1}]})", "/lights/0/intensity");
}

TEST_F(SceneFile, WrongTypesAndRangesAreNamedWithTheirPointer) {
    expectError("[]", ": expected an object");
    expectError(R"({"model": 3})", "/model: expected a string");
    expectError(R"({"cameras": {}})", "/cameras: expected an array");
    expectError(R"({"cameras": [{"name": "a", "target": [0,0,0]}]})",
                "/cameras/0: has no \"position\"");
    expectError(R"({"cameras": [{"name": "a", "position": [0,0], "target": [0,0,0]}]})",
                "/cameras/0/position: [0,0]; expected [x, y, z]");
    expectError(R"({"cameras": [{"name": "a", "position": [0,0,"z"], "target": [0,0,0]}]})",
                "/cameras/0/position/2: \"z\"; expected a number");
    expectError(R"({"cameras": [{"name": "a", "position": [1,1,1], "target": [1,1,1]}]})",
                "/cameras/0: camera \"a\": position and target");
    expectError(
        R"({"cameras": [{"name": "a", "position": [1,1,1], "target": [0,0,0], "fov_y": 200}]})",
        "/cameras/0/fov_y: 200; expected a number from 0.0 to 180.0");
    expectError(R"({"lights": [{"type": "tube"}]})", "/lights/0/type: unknown type of light");
    expectError(R"({"lights": [{}]})", "/lights/0: expected an object with a \"type\"");
    expectError(R"({"lights": [{"type": "directional", "direction": [0,0,0], "irradiance": 1}]})",
                "/lights/0/direction: a direction of no length");
    expectError(R"({"lights": [{"type": "rectangle", "center": [0,0,0], "edge_u": [1,0,0],
                    "edge_v": [2,0,0], "radiance": 1}]})",
                "/lights/0/edge_v: the edges span no area");
    expectError(R"({"lights": [{"type": "point", "position": [0,0,0], "intensity": -1}]})",
                "/lights/0/intensity: -1; expected a number, 0.0 or more");
    expectError(R"({"environment": {"ambient": "blue"}})",
                "/environment/ambient: \"blue\"; expected a number or [r, g, b]");
    expectError(R"({"materials": {"paint": {}}})", "no material is called \"paint\"");
}

TEST_F(SceneFile, UnknownNamesOfTheModelAreNamed) {
    const std::string with = R"({"model": "../model/square.gltf", )";
    expectError(with + R"("materials": {"pant": {}}})",
                "/materials/pant: no material is called \"pant\". Did you mean \"paint\"?");
    expectError(with + R"("probes": [{"position": [0,0,0], "object": "sqare"}]})",
                "/probes/0/object: no instance is called \"sqare\". Did you mean \"square\"?");
    expectError(with + R"("materials": {"paint": {"mirror": 2}}})",
                "/materials/paint/mirror: 2; expected a number from 0.0 to 1.0");
}

TEST_F(SceneFile, KeysWrittenTwiceAreRefused) {
    expectError(R"({"environment": {"ambient": 1, "ambient": 2}})", "\"ambient\" appears twice");
}

TEST_F(SceneFile, AMissingModelIsNamed) {
    const std::string what = error(R"({"model": "gone.gltf"})");
    EXPECT_NE(what.find("gone.gltf: cannot be read"), std::string::npos) << what;
    EXPECT_NE(loadError("nowhere.scene.json").find("nowhere.scene.json: cannot be read"),
              std::string::npos);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/core/scene/small_gltf.h"

#include <cmath>

namespace hone {
namespace {

/// A PNG of two pixels side by side: red, and green with alpha 128.
constexpr const char* kTwoPixels =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR4nGP4z8DwHwgbABB5A35"
    "9Y87XAAAAAElFTkSuQmCC";

void expectNear(vec3 actual, vec3 expected, float tolerance = 1e-6f) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(actual[c], expected[c], tolerance);
}

/// The corners of each triangle, sorted: finishScene orders triangles as it likes.
std::vector<std::array<uint, 3>> sortedTriangles(const Scene& scene) {
    std::vector<std::array<uint, 3>> triangles;
    for (const uvec3& t : scene.triangles)
        triangles.push_back({t.x, t.y, t.z});
    std::ranges::sort(triangles);
    return triangles;
}

Scene load(const SmallGltf& model) {
    const ScratchFolder folder;
    return loadScene(model.write(folder));
}

void addTexture(SmallGltf& model, const char* uri) {
    model.json["images"] = {{{"uri", uri}}};
    model.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    model.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    model.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
}

TEST(Gltf, ReadsTheSquare) {
    const Scene scene = load(SmallGltf());
    ASSERT_EQ(scene.positions.size(), 4u);
    EXPECT_EQ(scene.positions[2], vec3(1, 1, 0));
    EXPECT_EQ(scene.normals[2], vec3(0, 0, 1));
    EXPECT_EQ(scene.uvs[0], vec2(0, 1));
    EXPECT_EQ(sortedTriangles(scene), (std::vector<std::array<uint, 3>>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(scene.instance_names, std::vector<std::string>{"square"});
    EXPECT_EQ(scene.material_names, std::vector<std::string>{"paint"});
    EXPECT_EQ(scene.bounds.low, vec3(0, 0, 0));
    EXPECT_EQ(scene.bounds.high, vec3(1, 1, 0));
    EXPECT_NE(scene.version, 0u);
}

TEST(Gltf, GlbAndDataUriGiveTheSameSceneAsFiles) {
    const ScratchFolder folder;
    const SmallGltf model;
    const Scene files = loadScene(model.write(folder));
    const Scene glb = loadScene(folder.write("square.glb", model.glb()));
    EXPECT_EQ(files.positions, glb.positions);
    EXPECT_EQ(files.triangles, glb.triangles);
}

TEST(Gltf, AModelWithoutLightsGetsASunAndSaysSo) {
    const Scene scene = load(SmallGltf());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, kLightDirectional);
    EXPECT_TRUE(hasWarning(scene, {"square.gltf", "no lights"}));
}

TEST(Gltf, IndicesMayBeOf8And32BitsOrMissing) {
    SmallGltf bytes;
    const std::uint8_t small[] = {3, 2, 1};
    bytes.primitive()["indices"] = bytes.addAccessor(small, 5121, "SCALAR", 3);
    EXPECT_EQ(load(bytes).triangles, PagedVector<uvec3>{uvec3(3, 2, 1)});

    SmallGltf words;
    const std::uint32_t large[] = {3, 2, 1};
    words.primitive()["indices"] = words.addAccessor(large, 5125, "SCALAR", 3);
    EXPECT_EQ(load(words).triangles, PagedVector<uvec3>{uvec3(3, 2, 1)});

    SmallGltf none;
    none.primitive().erase("indices");
    for (std::size_t i = 0; i < 3; ++i)
        none.json["accessors"][i]["count"] = 3;
    EXPECT_EQ(load(none).triangles, PagedVector<uvec3>{uvec3(0, 1, 2)});
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
    // glTF 2.0, 3.7.2.1: strip triangle i is (i, i + 1 + i % 2, i + 2 - i % 2); fan (i + 1, i + 2,
    // 0).
    SmallGltf strip;
    const std::uint16_t corners[] = {0, 1, 3, 2};
    strip.primitive()["indices"] = strip.addAccessor(corners, 5123, "SCALAR", 4);
    strip.primitive()["mode"] = 5;
    EXPECT_EQ(sortedTriangles(load(strip)),
              (std::vector<std::array<uint, 3>>{{0, 1, 3}, {1, 2, 3}}));
    SmallGltf fan;
    const std::uint16_t around[] = {0, 1, 2, 3};
    fan.primitive()["indices"] = fan.addAccessor(around, 5123, "SCALAR", 4);
    fan.primitive()["mode"] = 6;
    EXPECT_EQ(sortedTriangles(load(fan)), (std::vector<std::array<uint, 3>>{{1, 2, 0}, {2, 3, 0}}));
}

TEST(Gltf, LinesAreLeftOutAndNamed) {
    SmallGltf model;
    model.json["meshes"][0]["name"] = "wires";
    model.primitive()["mode"] = 1;
    const Scene scene = load(model);
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(hasWarning(scene, {"square.gltf", "points and lines", "wires"}));
}

TEST(Gltf, MissingNormalsAreFlat) {
    SmallGltf model;
    const float bent[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1}; // the second triangle stands up
    model.put(SmallGltf::kPositions, bent);
    model.primitive()["attributes"].erase("NORMAL");
    const Scene scene = load(model);
    ASSERT_EQ(scene.positions.size(), 6u);
    // Triangle (0,0,0) (1,0,0) (1,1,0) faces +z; (0,0,0) (1,1,0) (0,0,1) has normal
    // (1,-1,0)/sqrt(2).
    expectNear(scene.normals[0], vec3(0, 0, 1));
    expectNear(scene.normals[3], vec3(std::sqrt(0.5f), -std::sqrt(0.5f), 0));
}

TEST(Gltf, NormalsBecomeUnitLengthAndBrokenOnesAreReplaced) {
    SmallGltf model;
    const float normals[] = {0, 3, 4, 0, 0, 0, NAN, 0, 0, 1e-30f, 0, 0};
    model.put(SmallGltf::kNormals, normals);
    const Scene scene = load(model);
    expectNear(scene.normals[0], vec3(0, 0.6f, 0.8f));
    expectNear(scene.normals[1], vec3(0, 0, 1));
    expectNear(scene.normals[2], vec3(0, 0, 1));
    expectNear(scene.normals[3], vec3(1, 0, 0));
}

TEST(Gltf, SparseValuesReplaceDenseOnes) {
    SmallGltf model;
    const std::uint16_t index[] = {2};
    const float value[] = {5, 6, 7};
    model.addAccessor(index, 5123, "SCALAR", 1);
    model.addAccessor(value, 5126, "VEC3", 1);
    model.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", 4}, {"componentType", 5123}}},
        {"values", {{"bufferView", 5}}}};
    const Scene scene = load(model);
    EXPECT_EQ(scene.positions[2], vec3(5, 6, 7));
    EXPECT_EQ(scene.positions[1], vec3(1, 0, 0));
}

TEST(Gltf, IntegerTextureCoordinatesAreNormalised) {
    SmallGltf model;
    const std::uint8_t uvs[] = {0, 255, 0, 0, 51, 255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0};
    const std::size_t accessor = model.addAccessor(uvs, 5121, "VEC2", 4);
    model.json["accessors"][accessor]["normalized"] = true;
    model.json["bufferViews"].back()["byteStride"] = 4;
    model.primitive()["attributes"]["TEXCOORD_0"] = accessor;
    const Scene scene = load(model);
    EXPECT_EQ(scene.uvs[0], vec2(0.0f, 1.0f));
    EXPECT_FLOAT_EQ(scene.uvs[1].x, 0.2f);
}

TEST(Gltf, TransformsRunDownTheHierarchy) {
    SmallGltf model;
    // Parent: move by (10, 0, 0). Child: scale (2, 3, 4), then turn 90 degrees about z, then move
    // up.
    const double half = std::sqrt(0.5);
    model.json["nodes"] = {
        {{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}},
        {{"mesh", 0},
         {"scale", {2, 3, 4}},
         {"rotation", {0, 0, half, half}},
         {"translation", {0, 5, 0}}}};
    const Scene scene = load(model);
    ASSERT_EQ(scene.instances.size(), 1u);
    const mat4x3& to_world = scene.instances[0].to_world;
    expectNear(to_world * vec4(1, 0, 0, 1), vec3(10, 7, 0), 1e-5f); // x turns to y, doubled
    expectNear(to_world * vec4(0, 1, 0, 1), vec3(7, 5, 0), 1e-5f);  // y turns to -x, tripled
    expectNear(to_world * vec4(0, 0, 1, 1), vec3(10, 5, 4), 1e-5f);
    EXPECT_EQ(scene.instances[0].flipped, 0u);
    // The plane's normal is still +z, a quarter as long; the x direction's is y, half as long.
    expectNear(scene.instances[0].normal_matrix * vec3(0, 0, 1), vec3(0, 0, 0.25f));
    expectNear(scene.instances[0].normal_matrix * vec3(1, 0, 0), vec3(0, 0.5f, 0));
}

TEST(Gltf, TwoNodesOfOneMeshShareIt) {
    SmallGltf model;
    model.json["nodes"].push_back({{"mesh", 0}, {"translation", {3, 0, 0}}});
    model.json["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(model);
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[1].mesh, scene.instances[0].mesh);
    EXPECT_EQ(scene.instancedTriangles(), 4u);
    EXPECT_EQ(scene.instance_names[1], "node 1");
}

TEST(Gltf, PrimitivesOfOneMeshAreInstancesAndShareVertices) {
    SmallGltf model;
    model.json["meshes"][0]["primitives"].push_back(model.primitive());
    const Scene scene = load(model);
    EXPECT_EQ(scene.positions.size(), 4u);
    EXPECT_EQ(scene.triangles.size(), 4u);
    EXPECT_EQ(scene.instance_names, (std::vector<std::string>{"square/0", "square/1"}));
}

TEST(Gltf, SmoothMetalIsAMirrorOfItsColour) {
    SmallGltf model;
    model.json["materials"][0]["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0.1}};
    const Material material = load(model).materials[0];
    EXPECT_EQ(material.flags, kMaterialMirror);
    expectNear(material.f0, vec3(0.9f, 0.6f, 0.3f));
    EXPECT_EQ(material.base_color, vec3(0));
}

TEST(Gltf, SmoothDielectricReflectsByItsIndexOfRefraction) {
    SmallGltf model;
    model.json["materials"][0]["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}};
    expectNear(load(model).materials[0].f0, vec3(0.04f)); // ((1.5 - 1) / (1.5 + 1))^2
    model.json["materials"][0]["extensions"]["KHR_materials_ior"]["ior"] = 3;
    const Material material = load(model).materials[0];
    expectNear(material.f0, vec3(0.25f)); // (2 / 4)^2
    EXPECT_EQ(material.base_color, vec3(0.5f));
}

TEST(Gltf, RoughMetalKeepsItsColourAsDiffuse) {
    SmallGltf model;
    model.json["materials"][0]["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0.11}};
    const Material material = load(model).materials[0];
    EXPECT_EQ(material.flags, 0u);
    EXPECT_EQ(material.f0, vec3(0));
    expectNear(material.base_color, vec3(0.9f, 0.6f, 0.3f));
}

TEST(Gltf, PrimitivesWithoutMaterialAreWhite) {
    SmallGltf model;
    model.primitive().erase("material");
    const Scene scene = load(model);
    EXPECT_EQ(scene.material_names, (std::vector<std::string>{"paint", "default"}));
    EXPECT_EQ(scene.materials[scene.meshes[0].material].base_color, vec3(1));
}

TEST(Gltf, EmissionIsFactorTimesStrength) {
    SmallGltf model;
    model.json["materials"][0]["emissiveFactor"] = {1, 0.5, 0};
    model.json["materials"][0]["doubleSided"] = true;
    model.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {
        {"emissiveStrength", 8}};
    const Material material = load(model).materials[0];
    EXPECT_EQ(material.emission, vec3(8, 4, 0));
    EXPECT_EQ(material.flags, kMaterialTwoSided);
}

TEST(Gltf, BlendIsDrawnAsMaskAndNamed) {
    SmallGltf model;
    model.json["materials"][0]["alphaMode"] = "BLEND";
    model.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.3};
    const Scene scene = load(model);
    EXPECT_EQ(scene.materials[0].flags, kMaterialMasked);
    EXPECT_EQ(scene.materials[0].alpha_cutoff, 0.5f);
    EXPECT_TRUE(hasWarning(scene, {"square.gltf", "BLEND", "paint"}));
    // Nothing of a surface with more alpha than the cutoff is ever a hole.
    model.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.8};
    EXPECT_EQ(load(model).materials[0].flags, 0u);
}

TEST(Gltf, UnsupportedOptionalExtensionsAreNamed) {
    SmallGltf model;
    model.json["extensionsUsed"] = {"KHR_materials_transmission"};
    model.json["materials"][0]["extensions"]["KHR_materials_transmission"] = {
        {"transmissionFactor", 1}};
    EXPECT_TRUE(hasWarning(load(model), {"KHR_materials_transmission", "paint"}));
}

TEST(Gltf, ReadsATextureWithItsLevelsAndWrapping) {
    SmallGltf model;
    addTexture(model, kTwoPixels);
    model.json["materials"][0]["alphaMode"] = "MASK";
    model.json["materials"][0]["alphaCutoff"] = 0.25;
    const Scene scene = load(model);
    ASSERT_EQ(scene.textures.size(), 1u);
    const Texture& texture = scene.textures[0];
    EXPECT_EQ(uvec3(texture.width, texture.height, texture.levels), uvec3(2, 1, 2));
    EXPECT_EQ(texture.wrap_u, 1u);
    EXPECT_EQ(texture.wrap_v, 2u);
    ASSERT_EQ(scene.texels.size(), 3u);
    EXPECT_EQ(scene.texels[0], 0xff0000ffu);
    EXPECT_EQ(scene.texels[1], 0x8000ff00u);
    // Weighted by alpha, red is 255 / 383 of the light (code 213) and green 128 / 383 (code 156);
    // alpha (255 + 128) / 2 rounds to 192.
    EXPECT_EQ(scene.texels[2], 0xc0009cd5u);
    EXPECT_EQ(scene.materials[0].base_color_texture, 0u);
    EXPECT_EQ(scene.materials[0].flags, kMaterialMasked);
    EXPECT_EQ(scene.materials[0].alpha_cutoff, 0.25f);
}

TEST(Gltf, AMissingTextureIsAWarningThatNamesIt) {
    SmallGltf model;
    addTexture(model, "textures/gone.png");
    const Scene scene = load(model);
    EXPECT_TRUE(hasWarning(scene, {"square.gltf", "textures/gone.png", "no such file", "paint"}));
    EXPECT_EQ(scene.materials[0].base_color_texture, kNone);
}

TEST(Gltf, ABrokenTextureIsAWarningThatNamesIt) {
    const ScratchFolder folder;
    SmallGltf model;
    addTexture(model, "broken.png");
    folder.write("broken.png", "\x89PNG\r\n\x1a\nand no more");
    const Scene scene = loadScene(model.write(folder));
    EXPECT_TRUE(hasWarning(scene, {"square.gltf", "broken.png", "paint"}));
    EXPECT_EQ(scene.materials[0].base_color_texture, kNone);
}

TEST(Gltf, ATextureOutsideTheFolderIsNotRead) {
    SmallGltf model;
    addTexture(model, "../../etc/passwd");
    EXPECT_TRUE(hasWarning(load(model), {"../../etc/passwd", "outside the model's folder"}));
}

TEST(Gltf, ReadsPunctualLightsAndCameras) {
    SmallGltf model;
    const double half = std::sqrt(0.5);
    model.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"color", {1, 0.5, 0.25}},
         {"intensity", 8},
         {"range", 20},
         {"spot", {{"innerConeAngle", 0.0}, {"outerConeAngle", 1.0471975512}}}}};
    model.json["cameras"] = {{{"type", "perspective"},
                              {"name", "eye"},
                              {"perspective", {{"yfov", 1.5707963268}, {"znear", 0.25}}}}};
    // A quarter turn about x takes -z to +y.
    model.json["nodes"].push_back({{"translation", {1, 2, 3}},
                                   {"rotation", {half, 0, 0, half}},
                                   {"camera", 0},
                                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    model.json["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(model);
    ASSERT_EQ(scene.lights.size(), 1u);
    const Light& light = scene.lights[0];
    EXPECT_EQ(light.kind, kLightSpot);
    expectNear(light.position, vec3(1, 2, 3));
    expectNear(light.direction, vec3(0, 1, 0));
    expectNear(light.intensity, vec3(8, 4, 2));
    EXPECT_NEAR(light.cos_outer, 0.5f, 1e-6f);
    EXPECT_EQ(light.cos_inner, 1.0f);
    EXPECT_EQ(light.range, 20.0f);
    const CameraDesc& camera = scene.camera("eye");
    expectNear(camera.position, vec3(1, 2, 3));
    expectNear(makeCamera(camera).forward, vec3(0, 1, 0));
    EXPECT_NEAR(camera.fov_y_degrees, 90.0f, 1e-4f);
    EXPECT_EQ(camera.near, 0.25f);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// The two real models that tests and benchmarks use, through the scene files that ship with the
// tests.
#include "hone/tests/core/scene/small_gltf.h"

namespace hone {
namespace {

Scene loadTestScene(const std::string& name) {
    return loadScene(std::string(HONE_SOURCE_DIR) + "/tests/scenes/" + name + ".scene.json");
}

#define SKIP_WITHOUT(model)                                                                        \
    if (!std::filesystem::exists(HONE_SOURCE_DIR "/../shared/scenes/" model))                      \
    GTEST_SKIP() << "../shared/scenes/" model " is not there"

TEST(SharedScenes, SponzaHasItsBunnyAndAllItsTextures) {
    SKIP_WITHOUT("sponza/sponza.gltf");
    const Scene scene = loadTestScene("sponza");
    EXPECT_EQ(scene.instancedTriangles(), 262267u + 69451u);
    EXPECT_EQ(scene.textures.size(), 21u);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    ASSERT_EQ(scene.probes.size(), 1u);
    const uint bunny = scene.probes[0].object;
    EXPECT_EQ(scene.instance_names[bunny], "mirror_bunny");
    EXPECT_EQ(scene.instances[bunny].probe, 0u);
    const Material& mirror = scene.materials[scene.meshes[scene.instances[bunny].mesh].material];
    EXPECT_NE(mirror.flags & kMaterialMirror, 0u);
    EXPECT_FLOAT_EQ(mirror.f0.x, 0.95f);
    for (const char* camera : {"nave", "balcony"})
        EXPECT_NO_THROW((void)makeCamera(scene.camera(camera)));
}

TEST(SharedScenes, SponzasFoliageAndChainsAreMasked) {
    SKIP_WITHOUT("sponza/sponza.gltf");
    const Scene scene = loadTestScene("sponza");
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const std::string& name = scene.material_names[i];
        const bool is_cut_out = name == "leaf" || name == "chain" || name == "Material__57";
        EXPECT_EQ((scene.materials[i].flags & kMaterialMasked) != 0, is_cut_out) << name;
    }
}

TEST(SharedScenes, PicaLoadsWithItsFlawsNamed) {
    SKIP_WITHOUT("pica/scene.gltf");
    const Scene scene = loadTestScene("pica");
    EXPECT_EQ(scene.instancedTriangles(), 76274u);
    EXPECT_EQ(scene.meshes.size(), 170u);
    EXPECT_EQ(scene.textures.size(), 5u); // the sixth holds roughness, which nothing looks up
    EXPECT_TRUE(hasWarning(scene, {"BLEND", "Glass_Dark_01"}));
    EXPECT_TRUE(hasWarning(scene, {"COLOR_0", "and 8 more"}));
    for (const vec3& normal : scene.normals)
        ASSERT_NEAR(glm::length(normal), 1.0f, 1e-5f);
}

} // namespace
} // namespace hone

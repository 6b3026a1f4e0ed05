// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

/// A triangle of each: plain, mirror, almost no mirror, masked. The image is one that shows them
/// side by side, and nothing.
Scene fourMaterials() {
    test::SceneBuilder builder;
    const vec3 positions[] = {{-9, -9, -5}, {9, -9, -5}, {0, 9, -5}};
    const uvec3 triangles[] = {{0, 1, 2}};
    for (const auto& [flags, f0] : {std::pair{0u, 0.0f},
                                    {kMaterialMirror, 1.0f},
                                    {kMaterialMirror, 1.0f / 1024.0f},
                                    {kMaterialMasked, 0.0f}}) {
        Material material = test::plainMaterial(flags);
        material.f0 = vec3(f0);
        builder.add(positions, triangles, builder.addMaterial(material));
    }
    return builder.finish();
}

std::vector<float> errorsOf(PassRun& run, const Scene& scene) {
    const Camera camera =
        makeCamera({.name = "", .position = {0, 0, 0}, .target = {0, 0, -1}, .fov_y_degrees = 1});
    run.extent({5, 1}).scene(scene).camera(camera);
    run.plane<Hit>("gbuffer", {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {kNone, kNone}}).execute();
    std::vector<float> errors;
    for (vec2 error : run.output<vec2>("error")) {
        EXPECT_EQ(error.x, error.y);
        errors.push_back(error.x);
    }
    return errors;
}

class Cab10 : public EachBuild {};
HONE_ON_EACH_BUILD(Cab10);

TEST_P(Cab10, FlagsWhatReflectsOrIsTransparent) {
    const Scene scene = fourMaterials();
    PassRun run = pass(cab10ErrorPass());
    EXPECT_EQ(errorsOf(run, scene), (std::vector<float>{0, 1, 0, 1, 0}));
}

TEST_P(Cab10, LeavesTransparencyOutWhenAsked) {
    const Scene scene = fourMaterials();
    PassRun run = pass(cab10ErrorPass());
    run.param("transparent", false);
    EXPECT_EQ(errorsOf(run, scene), (std::vector<float>{0, 1, 0, 0, 0}));
}

TEST_P(Cab10, IsTheFirstReflectionMetricWhereThereIsNoTransparency) {
    const Scene scene = fourMaterials();
    PassRun cab10 = pass(cab10ErrorPass()), first = pass(reflectionErrorPass());
    cab10.param("transparent", false);
    first.param("metric", 1u);
    EXPECT_EQ(errorsOf(cab10, scene), errorsOf(first, scene));
}

} // namespace
} // namespace hone

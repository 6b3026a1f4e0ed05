// SPDX-License-Identifier: Apache-2.0
//
// What is Embree's own; what every tracer promises is in tests/conformance.
#include "hone/backends/embree/embree_backend.h"

#include "hone/tests/support/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cctype>
#include <stdexcept>

namespace hone::test {
namespace {

/// `copies` instances of one square of two triangles, and a mesh of one triangle used once.
Scene copiedSquare(int copies) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const uint mesh = builder.addMesh(corners, std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}, material);
    for (int i = 0; i < copies; ++i)
        builder.addInstance(mesh, glm::translate(mat4(1), vec3(2 * i, 0, 0)));
    builder.add(corners, std::vector<uvec3>{{0, 1, 2}}, material);
    return builder.finish();
}

TEST(EmbreeBackend, FlattensCopiesWithinTheBudget) {
    const Scene scene = copiedSquare(5); // the copies add 4 * 2 triangles
    EXPECT_EQ(makeEmbreeBackend()->build(scene).triangles, 11u);
    EXPECT_EQ(makeEmbreeBackendWith({.flatten_triangles = 8})->build(scene).triangles, 11u);
    EXPECT_EQ(makeEmbreeBackendWith({.flatten_triangles = 7})->build(scene).triangles, 3u);
}

TEST(EmbreeBackend, FlattensTheMeshesFirstWhoseCopiesAddLeast) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial());
    const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    const uint large = builder.addMesh(corners, std::vector<uvec3>(9, {0, 1, 2}), material);
    const uint small = builder.addMesh(corners, std::vector<uvec3>(2, {0, 1, 2}), material);
    for (const uint mesh : {large, large, small, small, small}) // they add 9 and 4
        builder.addInstance(mesh);
    const Scene scene = builder.finish();
    EXPECT_EQ(makeEmbreeBackendWith({.flatten_triangles = 5})->build(scene).triangles, 9u + 6u);
    EXPECT_EQ(makeEmbreeBackendWith({.flatten_triangles = 13})->build(scene).triangles, 18u + 6u);
    EXPECT_EQ(makeEmbreeBackendWith({.flatten_triangles = 3})->build(scene).triangles, 9u + 2u);
}

TEST(EmbreeBackend, ReportsTheMemoryOfTheSceneItHoldsOnly) {
    const auto tracer = makeEmbreeBackend();
    const std::size_t small = tracer->build(copiedSquare(1)).bytes;
    const std::size_t large = tracer->build(copiedSquare(2000)).bytes;
    EXPECT_GT(small, 0u);
    EXPECT_GT(large, 10 * small);
    EXPECT_LT(tracer->build(copiedSquare(1)).bytes, large / 10);
}

TEST(EmbreeBackend, RefusesQueriesBeforeBuild) {
    const auto tracer = makeEmbreeBackend();
    const Ray ray{{0, 0, 1}, 0, {0, 0, -1}, 1};
    Hit hit;
    uint occluded = 0;
    EXPECT_THROW(tracer->closest({&ray, 1}, {&hit, 1}, Coherence::kCoherent, {}), std::logic_error);
    EXPECT_THROW(tracer->occluded({&ray, 1}, {&occluded, 1}, Coherence::kCoherent, {}),
                 std::logic_error);
}

TEST(EmbreeBackend, RefusesListsOfUnequalSize) {
    const auto tracer = makeEmbreeBackend();
    tracer->build(copiedSquare(1));
    const Ray ray{{0, 0, 1}, 0, {0, 0, -1}, 1};
    EXPECT_THROW(tracer->closest({&ray, 1}, {}, Coherence::kCoherent, {}), std::logic_error);
    EXPECT_THROW(tracer->occluded({&ray, 1}, {}, Coherence::kCoherent, {}), std::logic_error);
}

TEST(EmbreeBackend, NamesTheVersionItWasBuiltWith) {
    const TraceCaps caps = makeEmbreeBackend()->caps();
    EXPECT_EQ(caps.name, "embree");
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(caps.version.front())));
    EXPECT_FALSE(caps.always_exact);
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_acceleration.h"

#include "hone/backends/vulkan/vulkan_ray_features.h"
#include "hone/core/error.h"
#include "hone/tests/support/vulkan_fixture.h"

namespace hone::test {
namespace {

class VulkanTrees : public VulkanTest {
protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped())
            return;
        const RayTracing offered = rayTracing(device());
        if (!offered.query && !offered.pipeline)
            GTEST_SKIP() << device().info().driver << " offers no ray tracing";
    }
    [[nodiscard]] static AddressedBuffer buffer(VkDeviceSize bytes, VkDeviceSize alignment) {
        const VulkanInside inside = insideOf(device());
        return {inside.context(),
                inside.resources->memory,
                bytes,
                VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR,
                AddressedBuffer::Place::kMapped,
                "aligned",
                alignment};
    }
};

TEST_F(VulkanTrees, LieInBuffersAlignedAsAsked) {
    for (const VkDeviceSize alignment : {1u, 16u, 256u, 4096u}) {
        const AddressedBuffer aligned = buffer(100, alignment);
        EXPECT_NE(aligned.address(), 0u);
        EXPECT_EQ(aligned.address() % alignment, 0u);
        ASSERT_EQ(aligned.as<uint>().size(), 25u);
        aligned.as<uint>()[24] = 1; // mapped to its end
    }
}

TEST_F(VulkanTrees, SayWhichBufferIsTooLarge) {
    try {
        (void)buffer(VkDeviceSize{1} << 60, 1);
        FAIL() << "2^60 bytes";
    } catch (const OutOfMemory& error) {
        EXPECT_EQ(std::string(error.what()).find("aligned needs 1152921504606846976 bytes"), 0u)
            << error.what();
    }
}

TEST_F(VulkanTrees, RefuseMoreTrianglesThanTheDeviceTakes) {
    TreeInput input;
    input.addTriangles(0, 1u << 30, true);
    input.addTriangles(0, 1u << 30, false);
    try {
        const TreeStore store(insideOf(device()), {input}, "far too much");
        FAIL() << "2^31 triangles";
    } catch (const DeviceError& error) {
        EXPECT_EQ(
            std::string(error.what()).find("far too much has 2147483648 triangles in one tree; "),
            0u)
            << error.what();
    }
}

using VulkanRayKinds = VulkanTest;

TEST_F(VulkanRayKinds, AreThoseThatThePhysicalDeviceOffers) {
    const RayTracing offered = findRayTracing(insideOf(device()).context().chosen().device);
    const RayTracing opened = rayTracing(device());
    EXPECT_EQ(opened.query, offered.query);
    EXPECT_EQ(opened.pipeline, offered.pipeline);
}

TEST(VulkanRayFeatures, AskForNothingWhereNothingIsWanted) {
    const VulkanRayFeatures none({});
    EXPECT_TRUE(none.extensions.empty());
    EXPECT_EQ(none.chain, nullptr);
}

TEST(VulkanRayFeatures, AskForEachKindForItself) {
    const VulkanRayFeatures query({.query = true, .pipeline = false});
    EXPECT_EQ(query.extensions.size(), 3u);
    EXPECT_EQ(query.chain, &query.tree);
    EXPECT_EQ(query.tree.pNext, &query.query);
    const VulkanRayFeatures pipeline({.query = false, .pipeline = true});
    EXPECT_EQ(pipeline.extensions.size(), 3u);
    EXPECT_EQ(pipeline.chain, &pipeline.pipeline);
    EXPECT_EQ(pipeline.pipeline.pNext, &pipeline.tree);
    EXPECT_EQ(pipeline.tree.pNext, nullptr);
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/device/page_allocator.h"
#include "hone/core/scene/scene_buffers.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace hone {
namespace {

using VulkanImport = VulkanTest;

std::span<std::byte> bytesOf(PagedVector<uint>& words) {
    return std::as_writable_bytes(std::span(words));
}

/// The buffer that these words are; empty, and the test skips, where the device cannot.
#define IMPORT_OR_SKIP(buffer, words)                                                              \
    const Buffer buffer = device().importBuffer(bytesOf(words), #words);                           \
    if (!buffer)                                                                                   \
    GTEST_SKIP() << device().info().name << " does not import host memory"

TEST_F(VulkanImport, UsesTheHostsBytesWhereTheyAre) {
    PagedVector<uint> words(3000);
    std::iota(words.begin(), words.end(), 0u);
    IMPORT_OR_SKIP(imported, words);
    EXPECT_EQ(imported.as<uint>().data(), words.data());
    EXPECT_EQ(imported.bytes(), words.size() * sizeof(uint));

    // The device reads what the host wrote, also after the import, ...
    words[2999] = 77;
    const Buffer copy = device().createBuffer(imported.bytes(), "copy");
    encoder().copy(imported.view(), copy.view());
    encoder().finish();
    EXPECT_TRUE(std::ranges::equal(copy.as<uint>(), words));

    // ... and the host what the device wrote, in its stretch only.
    encoder().fill(imported.view().part(1024, 4096), 5);
    encoder().finish();
    EXPECT_EQ(words[255], 255u);
    EXPECT_EQ(words[256], 5u);
    EXPECT_EQ(words[1279], 5u);
    EXPECT_EQ(words[1280], 1280u);
}

TEST_F(VulkanImport, LeavesTheBytesToTheHostWhenTheBufferGoes) {
    PagedVector<uint> words(10'000, 3u);
    {
        IMPORT_OR_SKIP(imported, words);
        encoder().fill(imported.view(), 4);
        encoder().finish();
    }
    EXPECT_EQ(std::accumulate(words.begin(), words.end(), 0u), 40'000u);
    words.resize(20'000);
}

TEST_F(VulkanImport, MayTakeTheSameBytesTwice) {
    PagedVector<uint> words(1024, 1u);
    IMPORT_OR_SKIP(first, words);
    const Buffer second = device().importBuffer(bytesOf(words), "second");
    if (!second)
        GTEST_SKIP() << "the driver takes memory only once";
    encoder().fill(first.view(), 8);
    encoder().finish();
    EXPECT_EQ(second.as<uint>()[1023], 8u);
}

TEST_F(VulkanImport, FindsViewsOfImportedBytes) {
    PagedVector<uint> words(100);
    IMPORT_OR_SKIP(imported, words);
    const BufferView view = device().viewOf(std::as_bytes(std::span(words).subspan(10, 5)));
    EXPECT_EQ(view.handle, imported.view().handle);
    EXPECT_EQ(view.offset, 40u);
    EXPECT_EQ(view.bytes, 20u);
}

TEST_F(VulkanImport, RefusesBytesInTheMiddleOfAPage) {
    PagedVector<uint> words(100);
    EXPECT_FALSE(device().importBuffer(bytesOf(words).subspan(4), "askew"));
    EXPECT_FALSE(device().importBuffer({}, "nothing"));
}

TEST_F(VulkanImport, BringsASceneOverWithoutACopy) {
    test::SceneBuilder builder;
    builder.add(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<uvec3>{{0, 1, 2}},
                builder.addMaterial(test::plainMaterial()));
    const Scene scene = builder.finish();
    PagedVector<uint> words(1);
    IMPORT_OR_SKIP(imported, words);
    const SceneBuffers buffers(device(), scene);
    EXPECT_TRUE(buffers.copies().empty());
    EXPECT_EQ(buffers.find("scene_positions").as<vec3>().data(), scene.positions.data());
}

TEST_F(VulkanImport, CanBeSwitchedOff) {
    VulkanOptions without = options();
    without.host_import = false;
    const auto copying = makeVulkanDevice(without);
    PagedVector<uint> words(1024);
    EXPECT_FALSE(copying->importBuffer(bytesOf(words), "words"));
}

} // namespace
} // namespace hone

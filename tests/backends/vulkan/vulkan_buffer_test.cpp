// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/vulkan_fixture.h"

#include "hone/core/error.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace hone {
namespace {

using VulkanBuffers = VulkanTest;

bool isZero(const Buffer& buffer) {
    return std::ranges::all_of(buffer.as<std::byte>(),
                               [](std::byte byte) { return byte == std::byte{0}; });
}

TEST_F(VulkanBuffers, AreMappedAndZeroed) {
    const Buffer buffer = device().createBuffer(1000, "zeroed");
    ASSERT_NE(buffer.view().data, nullptr);
    EXPECT_EQ(buffer.bytes(), 1000u);
    EXPECT_TRUE(isZero(buffer));
}

TEST_F(VulkanBuffers, OfNoBytesHaveOneWord) {
    EXPECT_EQ(device().createBuffer(0, "empty").bytes(), 4u);
}

TEST_F(VulkanBuffers, AreZeroedAgainWhenTheirMemoryIsUsedAgain) {
    std::byte* first = nullptr;
    {
        const Buffer buffer = device().createBuffer(4096, "first owner");
        first = buffer.view().data;
        std::ranges::fill(buffer.as<std::byte>(), std::byte{0xab});
    }
    const Buffer buffer = device().createBuffer(4096, "second owner");
    EXPECT_EQ(buffer.view().data, first) << "freed memory is used again";
    EXPECT_TRUE(isZero(buffer));
}

TEST_F(VulkanBuffers, DoNotOverlapAfterManyFreesAndAllocations) {
    // Sizes from a few bytes to past the largest shared one (16 MiB), freed in another order.
    struct Owned {
        Buffer buffer;
        uint mark;
    };
    std::vector<Owned> owned;
    uint state = 1;
    const auto random = [&state] { return state = state * 1664525u + 1013904223u, state >> 8; };
    for (uint round = 0; round < 300; ++round) {
        if (owned.size() > 40)
            owned.erase(owned.begin() + static_cast<std::ptrdiff_t>(random() % owned.size()));
        const std::size_t bytes = round % 100 == 99 ? (20u << 20) : 4 * (1 + random() % 50000);
        Owned next{device().createBuffer(bytes, "churn"), round};
        std::ranges::fill(next.buffer.as<uint>(), round);
        owned.push_back(std::move(next));
    }
    for (const Owned& one : owned)
        EXPECT_TRUE(std::ranges::all_of(one.buffer.as<uint>(),
                                        [&](uint word) { return word == one.mark; }));
}

TEST_F(VulkanBuffers, AreCopiedByPart) {
    const Buffer source = device().createBuffer(4096, "source");
    const Buffer target = device().createBuffer(4096, "target");
    std::iota(source.as<uint>().begin(), source.as<uint>().end(), 0u);
    encoder().copy(source.view().part(1024, 512), target.view().part(256, 512));
    encoder().finish();
    for (uint i = 0; i < 1024; ++i)
        ASSERT_EQ(target.as<uint>()[i], i >= 64 && i < 192 ? i + 192 : 0u) << i;
}

TEST_F(VulkanBuffers, AreFilledByPart) {
    const Buffer buffer = device().createBuffer(64, "filled");
    encoder().fill(buffer.view().part(16, 32), 0xdeadbeef);
    encoder().finish();
    for (uint i = 0; i < 16; ++i)
        ASSERT_EQ(buffer.as<uint>()[i], i >= 4 && i < 12 ? 0xdeadbeefu : 0u) << i;
}

TEST_F(VulkanBuffers, OperationsSeeWhatThoseBeforeThemWrote) {
    const Buffer first = device().createBuffer(1 << 16, "first");
    const Buffer second = device().createBuffer(1 << 16, "second");
    encoder().fill(first.view(), 1);
    encoder().copy(first.view(), second.view());
    encoder().fill(first.view(), 2);
    encoder().copy(second.view().part(0, 64), first.view().part(128, 64));
    encoder().finish();
    EXPECT_EQ(first.as<uint>()[0], 2u);
    EXPECT_EQ(first.as<uint>()[32], 1u);
    EXPECT_EQ(first.as<uint>()[48], 2u);
    EXPECT_EQ(second.as<uint>()[0], 1u);
}

TEST_F(VulkanBuffers, MayBeDestroyedWhileRecordedWorkStillUsesThem) {
    const Buffer target = device().createBuffer(64, "target");
    {
        const Buffer source = device().createBuffer(64, "short-lived");
        std::ranges::fill(source.as<uint>(), 7u);
        encoder().copy(source.view(), target.view());
    }
    encoder().finish();
    EXPECT_EQ(target.as<uint>()[15], 7u);
}

TEST_F(VulkanBuffers, OfAbsurdSizeAreRefusedAndTheDeviceGoesOn) {
    for (const std::size_t bytes : {std::size_t{1} << 50, ~std::size_t{0}}) {
        try {
            static_cast<void>(device().createBuffer(bytes, "absurd"));
            FAIL() << "no device has so much memory";
        } catch (const OutOfMemory& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find("absurd"), text.npos) << text;
            EXPECT_NE(text.find(std::to_string(bytes)), text.npos) << text;
        }
    }
    const Buffer buffer = device().createBuffer(64, "modest");
    encoder().fill(buffer.view(), 3);
    encoder().finish();
    EXPECT_EQ(buffer.as<uint>()[0], 3u);
}

TEST_F(VulkanBuffers, OfAnotherDeviceAreRefused) {
    std::array<uint, 4> foreign{};
    const BufferView view{0x7f0000001000u, 0, 16, reinterpret_cast<std::byte*>(foreign.data())};
    EXPECT_THROW(encoder().fill(view, 1), std::logic_error);
}

TEST_F(VulkanBuffers, FinishWithNothingRecordedDoesNothing) {
    encoder().finish();
    encoder().finish();
}

} // namespace
} // namespace hone

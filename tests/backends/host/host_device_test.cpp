// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/host/host_device.h"

#include "hone/core/device/page_allocator.h"
#include "hone/core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <numeric>

namespace hone {
namespace {

/// Adds Params to each word and counts how often each invocation ran.
struct CountRuns {
    static void run(const Arguments& arguments, const void* params, uint begin, uint end) {
        uint step = 0;
        std::memcpy(&step, params, sizeof(step));
        const std::span<uint> words = arguments.find("words")->buffer.as<uint>();
        for (uint index = begin; index < end; ++index)
            words[index] += step;
    }
};
constexpr Kernel kCountRuns{
    .name = "count_runs", .spirv = {}, .params_bytes = sizeof(uint), .run = CountRuns::run};

class HostDevice : public testing::Test {
protected:
    void dispatch(BufferView words, uint step, uint count) {
        Arguments arguments;
        arguments.bind("words", words);
        device_->encoder().dispatch(kCountRuns, arguments, std::as_bytes(std::span(&step, 1)),
                                    count);
    }
    std::unique_ptr<Device> device_ = makeHostDevice();
};

TEST_F(HostDevice, CannotRaster) {
    EXPECT_FALSE(device_->info().can_raster);
    EXPECT_THROW(static_cast<void>(device_->createImage({})), DeviceError);
    EXPECT_THROW(device_->encoder().beginRaster({}), DeviceError);
}

TEST_F(HostDevice, UsesImportedBytesWhereTheyAreAndLeavesThemToTheirOwner) {
    PagedVector<uint> words(1000, 1u);
    {
        const Buffer imported =
            device_->importBuffer(std::as_writable_bytes(std::span(words)), "words");
        EXPECT_EQ(imported.as<uint>().data(), words.data());
        EXPECT_EQ(imported.bytes(), 4000u);
        dispatch(imported.view(), 2, 1000);
    }
    EXPECT_EQ(std::accumulate(words.begin(), words.end(), 0u), 3000u);
}

TEST_F(HostDevice, ZeroesBuffers) {
    const Buffer buffer = device_->createBuffer(1001, "zeroed");
    EXPECT_EQ(buffer.bytes(), 1001u);
    EXPECT_TRUE(std::ranges::all_of(buffer.as<std::byte>(),
                                    [](std::byte byte) { return byte == std::byte{0}; }));
}

TEST_F(HostDevice, GivesABufferOfNoBytesOneWord) {
    EXPECT_EQ(device_->createBuffer(0, "empty").bytes(), 4u);
}

TEST_F(HostDevice, RunsEachInvocationOnce) {
    for (const uint count : {0u, 1u, 1023u, 1024u, 1025u, 1'000'000u}) {
        const Buffer buffer = device_->createBuffer((count + 1) * sizeof(uint), "words");
        dispatch(buffer.view(), 3, count);
        const std::span<uint> words = buffer.as<uint>();
        EXPECT_TRUE(std::ranges::all_of(words.first(count), [](uint word) { return word == 3; }))
            << count;
        EXPECT_EQ(words[count], 0u) << count;
    }
}

TEST_F(HostDevice, CopiesAndFillsParts) {
    const Buffer source = device_->createBuffer(64, "source");
    const Buffer target = device_->createBuffer(64, "target");
    std::iota(source.as<uint>().begin(), source.as<uint>().end(), 0u);
    device_->encoder().copy(source.view().part(16, 16), target.view().part(32, 16));
    device_->encoder().fill(target.view().part(0, 8), 0xffffffffu);
    const std::array<uint, 16> expected{~0u, ~0u, 0, 0, 0, 0, 0, 0, 4, 5, 6, 7, 0, 0, 0, 0};
    EXPECT_TRUE(std::ranges::equal(target.as<uint>(), expected));
}

TEST_F(HostDevice, RefusesCopiesBetweenUnequalSizes) {
    const Buffer buffer = device_->createBuffer(64, "buffer");
    EXPECT_THROW(device_->encoder().copy(buffer.view().part(0, 16), buffer.view().part(32, 8)),
                 std::logic_error);
}

TEST_F(HostDevice, RefusesBuffersLargerThanMemoryAndGoesOn) {
    EXPECT_THROW(static_cast<void>(device_->createBuffer(std::size_t{1} << 60, "absurd")),
                 OutOfMemory);
    EXPECT_THROW(static_cast<void>(device_->createBuffer(~std::size_t{0}, "absurd")), OutOfMemory);
    EXPECT_EQ(device_->createBuffer(64, "modest").bytes(), 64u);
}

} // namespace
} // namespace hone

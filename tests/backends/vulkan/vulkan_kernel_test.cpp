// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/vulkan_fixture.h"

#include "hone/backends/host/host_device.h"
#include "hone/backends/vulkan/vulkan_encoder.h"
#include "hone/core/error.h"

#include "hone_spirv/affine.h"
#include "hone_spirv/tonemap.h"

#include "hone/core/device/kernel.glsl.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace hone {
namespace {

using VulkanKernels = VulkanTest;

struct Tonemap : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/tonemap/tonemap.glsl.h"
};
constexpr Kernel kTonemap = makeKernel<Tonemap>("tonemap", spirv::tonemap);

struct Affine : HostKernel {
    using HostKernel::HostKernel;
#include "hone/tests/backends/vulkan/affine.glsl.h"
};
constexpr Kernel kAffine = makeKernel<Affine>("affine", spirv::affine);

template <class T> std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

class VulkanTonemap : public VulkanTest, public testing::WithParamInterface<uint> {};

TEST_P(VulkanTonemap, OnTheDeviceIsThatOnTheHost) {
    const uint count = GetParam();
    const auto host = makeHostDevice();
    const Buffer color = device().createBuffer(count * sizeof(vec3), "color");
    // One element more than the dispatch: it must stay as it is.
    const Buffer display = device().createBuffer((count + 1) * sizeof(vec3), "display");
    const Buffer expected = device().createBuffer((count + 1) * sizeof(vec3), "expected");
    const std::span<vec3> radiance = color.as<vec3>();
    for (uint i = 0; i < count; ++i)
        radiance[i] = vec3(float(i % 997u) / 300.0f, float(i % 13u) * 1e-4f, -float(i % 7u));
    std::ranges::fill(display.as<float>(), 9.0f);
    std::ranges::fill(expected.as<float>(), 9.0f);

    const Tonemap::Params params{.exposure = 1.5f, .curve = 1};
    Arguments arguments;
    arguments.bind("color", color.view());
    arguments.bind("display", display.view());
    encoder().dispatch(kTonemap, arguments, bytesOf(params), count);
    encoder().finish();
    arguments.bind("display", expected.view());
    host->encoder().dispatch(kTonemap, arguments, bytesOf(params), count);

    // pow() may differ: Vulkan allows it 16 + 3 |1/2.4 log2(x)| ulp of its result, here (x above
    // 1e-4) fewer than 34 ulp of 1, which is 4e-6.
    float worst = 0;
    for (std::size_t i = 0; i < display.as<float>().size(); ++i)
        worst = std::max(worst, std::abs(display.as<float>()[i] - expected.as<float>()[i]));
    EXPECT_LE(worst, 4e-6f);
    EXPECT_EQ(display.as<vec3>()[count].x, 9.0f);
}

// Around a workgroup (64), and more workgroups than one row has (65535 on many devices: 4194240
// invocations).
INSTANTIATE_TEST_SUITE_P(Counts, VulkanTonemap, testing::Values(0, 1, 63, 64, 65, 5'000'000),
                         testing::PrintToStringParamName());

TEST_F(VulkanKernels, ReadArraysOfBuffersWithSomeElementsMissing) {
    constexpr uint kCount = 100;
    std::vector<Buffer> summands;
    Arguments arguments;
    for (uint k = 0; k < 3; ++k) {
        summands.push_back(device().createBuffer(kCount * sizeof(uint), "summand"));
        for (uint i = 0; i < kCount; ++i)
            summands[k].as<uint>()[i] = (k + 1) * 1000 + i;
        arguments.bind("summands", summands[k].view(), k);
    }
    const Buffer sum = device().createBuffer(kCount * sizeof(uint), "sum");
    arguments.bind("sum", sum.view());
    const Affine::Params params{.used = 3, .scale = vec3(1, 2, 4), .offset = 10};
    encoder().dispatch(kAffine, arguments, bytesOf(params), kCount);
    encoder().finish();
    for (uint i = 0; i < kCount; ++i)
        ASSERT_EQ(sum.as<uint>()[i], 10 + 7 + 6000 + 3 * i);
}

TEST_F(VulkanKernels, SeeWhatKernelsBeforeThemWrote) {
    constexpr uint kCount = 10000;
    const Buffer sum = device().createBuffer(kCount * sizeof(uint), "sum");
    Arguments arguments;
    arguments.bind("sum", sum.view());
    const Affine::Params params{.used = 0, .scale = vec3(0), .offset = 1};
    for (uint i = 0; i < 300; ++i)
        encoder().dispatch(kAffine, arguments, bytesOf(params), kCount);
    encoder().finish();
    EXPECT_TRUE(std::ranges::all_of(sum.as<uint>(), [](uint word) { return word == 300; }));
}

TEST_F(VulkanKernels, RunAgainAfterFinishWithOtherBuffers) {
    for (uint round = 1; round <= 3; ++round) {
        const Buffer sum = device().createBuffer(4 * round, "sum");
        Arguments arguments;
        arguments.bind("sum", sum.view());
        const Affine::Params params{.used = 0, .scale = vec3(0), .offset = round};
        encoder().dispatch(kAffine, arguments, bytesOf(params), round);
        encoder().finish();
        EXPECT_EQ(sum.as<uint>()[round - 1], round);
    }
}

TEST_F(VulkanKernels, ReadAPartOfABuffer) {
    const Buffer whole = device().createBuffer(4096, "whole");
    whole.as<uint>()[256] = 5;
    const Buffer sum = device().createBuffer(4, "sum");
    Arguments arguments;
    arguments.bind("sum", sum.view());
    arguments.bind("summands", whole.view().part(1024, 256));
    const Affine::Params params{.used = 1, .scale = vec3(0), .offset = 0};
    encoder().dispatch(kAffine, arguments, bytesOf(params), 1);
    encoder().finish();
    EXPECT_EQ(sum.as<uint>()[0], 5u);
}

TEST_F(VulkanKernels, WithoutABufferSayWhich) {
    const Affine::Params params{};
    try {
        encoder().dispatch(kAffine, Arguments{}, bytesOf(params), 1);
        FAIL() << "sum is not bound";
    } catch (const std::logic_error& error) {
        EXPECT_NE(std::string(error.what()).find("affine: no buffer is bound to sum"),
                  std::string::npos)
            << error.what();
    }
    encoder().finish();
}

TEST_F(VulkanKernels, WithoutADeviceBuildAreRefused) {
    Kernel host_only = kAffine;
    host_only.spirv = {};
    const Affine::Params params{};
    EXPECT_THROW(encoder().dispatch(host_only, Arguments{}, bytesOf(params), 1), DeviceError);
}

TEST_F(VulkanKernels, AreTimedByScope) {
    const Buffer sum = device().createBuffer(4 << 20, "sum");
    Arguments arguments;
    arguments.bind("sum", sum.view());
    const Affine::Params params{.used = 0, .scale = vec3(0), .offset = 1};
    static_cast<void>(device().takeTimings());
    encoder().beginScope("outer");
    for (int i = 0; i < 2; ++i) {
        encoder().beginScope("inner");
        encoder().dispatch(kAffine, arguments, bytesOf(params), 1 << 20);
        encoder().finish(); // scopes live across submissions
        encoder().endScope();
    }
    encoder().endScope();
    const std::vector<ScopeTiming> timings = device().takeTimings();
    if (timings.empty())
        GTEST_SKIP() << "the queue has no clock";
    ASSERT_EQ(timings.size(), 2u);
    EXPECT_EQ(timings[0].name, "outer");
    EXPECT_EQ(timings[1].name, "inner");
    EXPECT_GT(timings[1].ms, 0);
    EXPECT_GE(timings[0].ms, timings[1].ms);
    EXPECT_TRUE(device().takeTimings().empty()) << "taken once";
}

TEST_F(VulkanKernels, WaitOnlyForWhatTheyMeet) {
    const auto& vulkan = dynamic_cast<const VulkanEncoder&>(encoder());
    constexpr uint kCount = 1000;
    std::vector<Buffer> buffers;
    for (int i = 0; i < 4; ++i)
        buffers.push_back(device().createBuffer(kCount * sizeof(uint), "sums"));
    std::ranges::fill(buffers[3].as<uint>(), 5u);
    const auto add = [&](std::size_t from, std::size_t to) {
        Arguments arguments;
        arguments.bind("summands", buffers[from].view());
        arguments.bind("sum", buffers[to].view());
        encoder().dispatch(kAffine, arguments,
                           bytesOf(Affine::Params{.used = 1, .scale = {}, .offset = 0}), kCount);
    };
    encoder().finish();
    const std::uint64_t before = vulkan.barriers();
    add(3, 0);
    add(3, 1);
    add(3, 2);
    EXPECT_EQ(vulkan.barriers() - before, 0u) << "all read one and write another";
    add(0, 1);
    EXPECT_EQ(vulkan.barriers() - before, 1u);
    add(0, 2);
    EXPECT_EQ(vulkan.barriers() - before, 1u) << "the last barrier was for this, too";
    add(1, 2);
    EXPECT_EQ(vulkan.barriers() - before, 2u);
    encoder().finish();
    EXPECT_EQ(buffers[1].as<uint>()[kCount - 1], 5u + 5u);
    EXPECT_EQ(buffers[2].as<uint>()[kCount - 1], 5u + 5u + 10u);
}

} // namespace
} // namespace hone

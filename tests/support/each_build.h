// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/passes/passes.h"
#include "hone/tests/support/run_pass.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <gtest/gtest.h>

namespace hone {

/// Where a pass's kernels run.
enum class Build : std::uint8_t { kHost, kDevice };

[[nodiscard]] const char* name(Build build); ///< "OnHost", "OnDevice"

/// TEST_Ps that run on the host's build of the kernels and on the Vulkan device's, which skips
/// where there is none:
///
///     class Combine : public EachBuild {};
///     HONE_ON_EACH_BUILD(Combine);
///     TEST_P(Combine, ...) { PassRun run = pass(combinePass()); ...
class EachBuild : public VulkanTest, public testing::WithParamInterface<Build> {
public:
    /// A pass on the running test's build; memory is that of the device that runs it.
    [[nodiscard]] static PassRun pass(PassType type);

protected:
    void SetUp() override;
};

/// The same for passes that rasterise, or read what such passes wrote: memory is the Vulkan
/// device's on both builds, and both skip where there is none.
class EachRasterBuild : public EachBuild {
public:
    [[nodiscard]] static PassRun pass(PassType type);

protected:
    void SetUp() override { VulkanTest::SetUp(); }
};

#define HONE_ON_EACH_BUILD(Suite)                                                                  \
    INSTANTIATE_TEST_SUITE_P(, Suite, testing::Values(Build::kHost, Build::kDevice),               \
                             [](const auto& each) { return name(each.param); })

} // namespace hone

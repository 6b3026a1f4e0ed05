// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_device.h"

#include <gtest/gtest.h>

namespace hone {

/// A test on a Vulkan device with validation (also of synchronisation) on: any message of the layer
/// fails the test. All tests of a program share one device, made at first use; where there is none
/// or no validation layer, tests skip and say why. HONE_TEST_DEVICE picks a device as
/// VulkanOptions::device does.
class VulkanTest : public testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] static Device& device();
    [[nodiscard]] static CommandEncoder& encoder() { return device().encoder(); }

    /// For a test that makes a device of its own: its messages count like the shared device's.
    [[nodiscard]] static VulkanOptions options();
};

/// The device that VulkanTest's tests share, for tests with another fixture: a message of the layer
/// fails the program at its end. Throws DeviceError, with the reason, where there is none.
[[nodiscard]] Device& sharedVulkanDevice();

} // namespace hone

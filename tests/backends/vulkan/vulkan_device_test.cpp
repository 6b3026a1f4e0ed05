// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_check.h"
#include "hone/backends/vulkan/vulkan_device.h"
#include "hone/tests/support/vulkan_fixture.h"

#include "hone/core/error.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace hone {
namespace {

using VulkanDevices = VulkanTest;

std::string messageFor(const VulkanOptions& options) {
    try {
        static_cast<void>(makeVulkanDevice(options));
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "";
}

TEST_F(VulkanDevices, SayWhatTheyAre) {
    EXPECT_FALSE(device().info().name.empty());
    EXPECT_FALSE(device().info().driver.empty());
    EXPECT_TRUE(device().info().can_raster);
}

TEST_F(VulkanDevices, AreListedWithTheOneInUse) {
    const std::vector<VulkanDeviceReport> reports = listVulkanDevices();
    const auto found = std::ranges::find(reports, device().info().name, &VulkanDeviceReport::name);
    ASSERT_NE(found, reports.end());
    EXPECT_TRUE(found->usable);
    EXPECT_EQ(found->missing, "");
    EXPECT_EQ(found->driver, device().info().driver);
    EXPECT_TRUE(found->api_version.starts_with("1."));
}

TEST_F(VulkanDevices, AreChosenByPartOfTheirNameInAnyCase) {
    std::string part = device().info().name.substr(1);
    std::ranges::transform(part, part.begin(), [](unsigned char letter) {
        return static_cast<char>(std::toupper(letter));
    });
    VulkanOptions wish = options();
    wish.device = part;
    EXPECT_EQ(makeVulkanDevice(wish)->info().name, device().info().name);
}

TEST_F(VulkanDevices, AreChosenByIndex) {
    const std::vector<VulkanDeviceReport> reports = listVulkanDevices();
    for (std::size_t i = 0; i < reports.size(); ++i) {
        if (!reports[i].usable)
            continue;
        VulkanOptions wish = options();
        wish.device = std::to_string(i);
        EXPECT_EQ(makeVulkanDevice(wish)->info().name, reports[i].name);
    }
}

TEST_F(VulkanDevices, ThatDoNotExistAreRefusedWithAListOfThoseThatDo) {
    for (const char* wish : {"no such device", "99"}) {
        const std::string text =
            messageFor({.device = wish, .validation = false, .on_message = {}});
        EXPECT_NE(text.find(std::string("\"") + wish + "\""), text.npos) << text;
        EXPECT_NE(text.find(device().info().name), text.npos) << text;
    }
}

TEST_F(VulkanDevices, MayBeSeveralAtOnce) {
    const std::unique_ptr<Device> second = makeVulkanDevice(options());
    const Buffer ours = device().createBuffer(64, "ours");
    const Buffer theirs = second->createBuffer(64, "theirs");
    encoder().fill(ours.view(), 1);
    second->encoder().fill(theirs.view(), 2);
    second->encoder().finish();
    encoder().finish();
    EXPECT_EQ(ours.as<uint>()[0], 1u);
    EXPECT_EQ(theirs.as<uint>()[0], 2u);
}

TEST_F(VulkanDevices, PassOnWhatTheValidationLayerSays) {
    std::vector<std::string> heard;
    VulkanOptions own = options();
    own.on_message = [&heard](std::string_view message) { heard.emplace_back(message); };
    const std::unique_ptr<Device> careless = makeVulkanDevice(own);
    const Buffer buffer = careless->createBuffer(64, "misused");
    careless->encoder().fill(buffer.view().part(0, 4096), 0); // recorded, never run
    EXPECT_FALSE(heard.empty()) << "a fill past the end is an error";
}

TEST(VulkanCheck, ThrowsWithTheCallAndTheResultsName) {
    try {
        checkResult(VK_ERROR_DEVICE_LOST, "vkQueueSubmit2(...)", "frame");
        FAIL() << "a lost device is an error";
    } catch (const DeviceError& error) {
        EXPECT_STREQ(error.what(),
                     "vkQueueSubmit2(...) returned VK_ERROR_DEVICE_LOST (-4) for frame");
    }
}

TEST(VulkanCheck, ThrowsOutOfMemoryForBothKinds) {
    EXPECT_THROW(checkResult(VK_ERROR_OUT_OF_HOST_MEMORY, "f"), OutOfMemory);
    EXPECT_THROW(checkResult(VK_ERROR_OUT_OF_DEVICE_MEMORY, "f"), OutOfMemory);
}

TEST(VulkanCheck, PassesOnWhatIsNoFailure) {
    EXPECT_EQ(checkResult(VK_INCOMPLETE, "f"), VK_INCOMPLETE);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/vulkan_fixture.h"

#include "hone/core/error.h"

#include <cstdlib>
#include <string>
#include <vector>

namespace hone {
namespace {

/// What the layer said since the last look.
std::vector<std::string>& messages() {
    static std::vector<std::string> instance;
    return instance;
}

void failOnMessages() {
    for (const std::string& message : messages())
        ADD_FAILURE() << message;
    messages().clear();
}

/// The program's device. Destroyed after the last test, when leaks would be told.
class SharedDevice : public testing::Environment {
public:
    void TearDown() override {
        device_.reset();
        failOnMessages();
    }

    /// Null, with a reason, where there is no device to test on.
    Device* get(const VulkanOptions& options) {
        if (device_ == nullptr && skip_reason_.empty()) {
            try {
                device_ = makeVulkanDevice(options);
            } catch (const DeviceError& error) {
                skip_reason_ = error.what();
            }
        }
        return device_.get();
    }
    [[nodiscard]] const std::string& skipReason() const { return skip_reason_; }

private:
    std::unique_ptr<Device> device_;
    std::string skip_reason_;
};

// GoogleTest owns it.
auto* const shared_device =
    static_cast<SharedDevice*>(testing::AddGlobalTestEnvironment(new SharedDevice));

VulkanOptions checkedOptions() {
    VulkanOptions result;
    if (const char* name = std::getenv("HONE_TEST_DEVICE"))
        result.device = name;
    result.validation = true;
    result.on_message = [](std::string_view message) { messages().emplace_back(message); };
    return result;
}

} // namespace

Device& sharedVulkanDevice() {
    if (Device* const device = shared_device->get(checkedOptions()))
        return *device;
    throw DeviceError(shared_device->skipReason());
}

VulkanOptions VulkanTest::options() {
    return checkedOptions();
}

Device& VulkanTest::device() {
    return *shared_device->get(options());
}

void VulkanTest::SetUp() {
    if (shared_device->get(options()) == nullptr)
        GTEST_SKIP() << shared_device->skipReason();
}

void VulkanTest::TearDown() {
    failOnMessages();
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"

#include <functional>

namespace hone {

struct VulkanOptions {
    /// Part of a device's name, or its index as a number; "" takes a discrete GPU before an
    /// integrated one before software.
    std::string device;
    /// Turns on the Khronos validation layer (core and synchronisation). Throws DeviceError if it
    /// is not installed.
    bool validation = false;
    /// Opens the device with its ray queries and ray pipelines, as far as it offers them; false
    /// leaves them off (a driver whose trees are broken).
    bool ray_tracing = true;
    /// Buffers may use memory of the host where it is (Device::importBuffer), as far as the device
    /// can; false: everything is copied, as on a device that cannot.
    bool host_import = true;
    /// Called for each validation message; a message is never swallowed: without a callback it is
    /// logged as a warning.
    std::function<void(std::string_view message)> on_message;
};

/// A headless Vulkan 1.3 device with a graphics queue. Throws DeviceError that says what was found
/// and what is missing.
[[nodiscard]] std::unique_ptr<Device> makeVulkanDevice(const VulkanOptions& options);

/// What hone doctor prints about one physical device.
struct VulkanDeviceReport {
    std::string name, driver, api_version;
    bool usable = false;
    std::string missing;       ///< why not, "" if usable
    bool ray_query = false;    ///< tracers may ask from any kernel
    bool ray_pipeline = false; ///< tracers may run ray generation and hit shaders
    bool host_import = false;  ///< uses memory of the host where it is (Device::importBuffer)
};
/// All devices in the loader's order, usable or not. Throws DeviceError if there is no driver.
[[nodiscard]] std::vector<VulkanDeviceReport> listVulkanDevices();

} // namespace hone

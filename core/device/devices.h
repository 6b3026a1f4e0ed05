// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"

namespace hone {

/// The devices that a program offers to graphs and tracers. They must outlive whatever uses them.
struct Devices {
    Device* host = nullptr; ///< runs kernels on all cores; always there
    /// Vulkan; null where there is none: what needs it then throws DeviceError.
    Device* raster = nullptr;

    /// Where buffers live. Both devices can use them.
    [[nodiscard]] Device& memory() const { return raster != nullptr ? *raster : *host; }
};

} // namespace hone

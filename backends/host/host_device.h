// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"

namespace hone {

/// The host as a device: runs kernels' native builds on all cores of the calling thread's oneTBB
/// arena, at once, over any device's mapped buffers. Cannot rasterise.
[[nodiscard]] std::unique_ptr<Device> makeHostDevice();

} // namespace hone

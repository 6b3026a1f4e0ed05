// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

namespace hone {

/// The Vulkan device of `devices`. Throws DeviceError that names the tracer that needs it.
[[nodiscard]] Device& vulkanOf(const Devices& devices, const char* tracer);

/// Tracing in compute shaders, the way that works on every Vulkan device.
[[nodiscard]] std::unique_ptr<TraceBackend> makeComputeTracer(Device& device);

/// Tracing on the Vulkan device, in the best way that it offers: ray queries, else ray pipelines,
/// else its compute shaders. Logs what it took, which caps().name says, too. Throws DeviceError.
[[nodiscard]] std::unique_ptr<TraceBackend> makeVulkanTracer(const Devices& devices);

} // namespace hone

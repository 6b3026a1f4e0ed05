// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/graph/executor.h"

#include <memory>
#include <string>

namespace hone::cli {

/// Everything that commands share: what graphs may use, and the devices that they run on.
class Session {
public:
    /// Registers passes and trace backends. Opens no device.
    Session();
    [[nodiscard]] Catalog catalog() const { return {&passes_, &trace_backends_}; }
    [[nodiscard]] const PassRegistry& passes() const { return passes_; }
    [[nodiscard]] const TraceBackendRegistry& traceBackends() const { return trace_backends_; }

    /// Opens the host and the named Vulkan device ("" = the best; "none" = no Vulkan). Without a
    /// usable Vulkan device the host alone is there, and raster_problem() says why.
    Devices openDevices(const std::string& vulkan_name, bool validation);
    [[nodiscard]] const std::string& rasterProblem() const { return raster_problem_; }
    /// Validation messages since the devices were opened.
    [[nodiscard]] std::size_t validationMessages() const { return validation_messages_; }

private:
    PassRegistry passes_;
    TraceBackendRegistry trace_backends_;
    std::unique_ptr<Device> host_;
    std::unique_ptr<Device> vulkan_;
    std::string raster_problem_;
    std::size_t validation_messages_ = 0;
};

} // namespace hone::cli

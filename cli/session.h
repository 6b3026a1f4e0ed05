// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/graph/executor.h"
#include "hone/core/plugin/plugin.h"
#include "hone/core/trace/check/check_backend.h"
#include "hone/core/trace/record/trace_recorder.h"
#include "hone/passes/glsl/glsl.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hone::cli {

/// Everything that commands share: what graphs may use, and the devices that they run on.
class Session {
public:
    /// Registers passes, trace backends, and those of plug-ins: first `plugins`, files that the
    /// person named, which must load (PluginError); then what the folders of HONE_PLUGIN_PATH and
    /// the installed plug-in folder have, where what does not load is warned about and left out.
    /// Opens no device.
    explicit Session(std::span<const std::string> plugins = {});
    [[nodiscard]] Catalog catalog() const;
    [[nodiscard]] const PassRegistry& passes() const { return passes_; }
    [[nodiscard]] const TraceBackendRegistry& traceBackends() const { return trace_backends_; }
    /// What backends with names like check(embree) found so far.
    [[nodiscard]] const CheckReport& checkReport() const { return check_report_; }
    /// Records every backend that is made from now on; `recorder` must outlive them.
    void record(TraceRecorder& recorder);

    [[nodiscard]] std::span<const Plugin> plugins() const { return plugins_; }
    /// Why plug-ins that were found were left out.
    [[nodiscard]] std::span<const std::string> pluginProblems() const { return plugin_problems_; }

    /// Opens the host and the named Vulkan device ("" = the best; "none" = no Vulkan). Without a
    /// usable Vulkan device the host alone is there, and raster_problem() says why.
    Devices openDevices(const std::string& vulkan_name, bool validation);
    [[nodiscard]] const std::string& rasterProblem() const { return raster_problem_; }
    /// Validation messages since the devices were opened.
    [[nodiscard]] std::size_t validationMessages() const { return validation_messages_; }

private:
    PassRegistry passes_;
    ShaderCompiler shaders_ = glslCompiler(passes_);
    CheckReport check_report_;
    TraceBackendRegistry trace_backends_;
    std::vector<Plugin> plugins_;
    std::vector<std::string> plugin_problems_;
    std::unique_ptr<Device> host_;
    std::unique_ptr<Device> vulkan_;
    std::string raster_problem_;
    std::size_t validation_messages_ = 0;
};

} // namespace hone::cli

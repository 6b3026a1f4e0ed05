// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/session.h"

#include "hone/backends/backends.h"
#include "hone/backends/host/host_device.h"
#include "hone/backends/host/parallel_for.h"
#include "hone/backends/vulkan/vulkan_device.h"
#include "hone/cli/install_paths.h"
#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/core/plugin/plugin_search.h"
#include "hone/passes/passes.h"

#include <cstdlib>

namespace hone::cli {

Session::Session(std::span<const std::string> plugins) {
    registerPasses(passes_);
    registerTraceBackends(trace_backends_);
    trace_backends_.reportChecksTo(check_report_);

    PluginSearch search;
    search.files.assign(plugins.begin(), plugins.end());
    // secure_getenv: whoever starts a program with more rights than their own must not choose its
    // code.
    if (const char* folders = secure_getenv("HONE_PLUGIN_PATH"))
        search.folders = foldersOfVariable("HONE_PLUGIN_PATH", folders, plugin_problems_);
    if (std::filesystem::path installed = installedPlugins(); !installed.empty())
        search.folders.push_back(std::move(installed));
    plugins_ = loadPlugins(search, passes_, trace_backends_, hostParallelFor, plugin_problems_);
    for (const std::string& problem : plugin_problems_)
        logger().warn("{}", problem);
}

Catalog Session::catalog() const {
    return {&passes_, &trace_backends_, &shaders_, shippedGraphs().string()};
}

void Session::record(TraceRecorder& recorder) {
    trace_backends_.wrapEach([&recorder](std::unique_ptr<TraceBackend> backend) {
        return makeRecordBackend(std::move(backend), recorder);
    });
}

Devices Session::openDevices(const std::string& vulkan_name, bool validation) {
    host_ = makeHostDevice();
    if (vulkan_name == "none") {
        raster_problem_ = "no Vulkan device was asked for (--device none)";
        return {host_.get(), nullptr};
    }
    VulkanOptions options;
    options.device = vulkan_name;
    options.validation = validation;
    options.on_message = [this](std::string_view message) {
        ++validation_messages_;
        logger().warn("validation: {}", message);
    };
    try {
        vulkan_ = makeVulkanDevice(options);
    } catch (const DeviceError& problem) {
        // A device that was asked for by name must be there; otherwise graphs that do not rasterise
        // still run.
        if (!vulkan_name.empty() || validation)
            throw;
        raster_problem_ = problem.what();
    }
    return {host_.get(), vulkan_.get()};
}

} // namespace hone::cli

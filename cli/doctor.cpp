// SPDX-License-Identifier: Apache-2.0
//
// hone doctor: what works on this machine, and what to install.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include "hone/backends/vulkan/vulkan_device.h"
#include "hone/core/error.h"
#include "hone/core/printable.h"

#include <ostream>
#include <thread>

namespace hone::cli {

int doctor(const DoctorArguments& arguments, const Console& console) {
    using Json = nlohmann::ordered_json;
    Json report;
    Json checks = Json::array();
    bool can_raster = false;
    const auto say = [&](const std::string& what, bool works, const std::string& detail,
                         const std::string& cure) {
        checks.push_back(
            {{"check", what}, {"ok", works}, {"detail", detail}, {"cure", works ? "" : cure}});
        if (!arguments.json)
            console.out << (works ? "ok       " : "missing  ") << what << ": " << detail
                        << (works || cure.empty() ? "" : "\n         " + cure) << "\n";
    };

    say("processor", true, std::to_string(std::thread::hardware_concurrency()) + " threads", "");
    std::vector<VulkanDeviceReport> devices;
    std::string loader_problem = "no device";
    try {
        devices = listVulkanDevices();
    } catch (const DeviceError& problem) {
        loader_problem = problem.what();
    }
    for (const VulkanDeviceReport& device : devices) {
        can_raster = can_raster || device.usable;
        say("Vulkan device", device.usable,
            device.name + " (" + device.driver + ", Vulkan " + device.api_version + ", ray query " +
                (device.ray_query ? "yes" : "no") + ", ray pipeline " +
                (device.ray_pipeline ? "yes" : "no") + ", imports host memory " +
                (device.host_import ? "yes" : "no") + ")",
            device.missing);
    }
    if (devices.empty())
        say("Vulkan device", false, loader_problem,
            "apt install mesa-vulkan-drivers (software, always works)");

    bool validation = false;
    std::string validation_detail = "Khronos validation layer";
    if (can_raster) {
        try {
            VulkanOptions options;
            options.validation = true;
            validation = makeVulkanDevice(options) != nullptr;
        } catch (const DeviceError& problem) {
            validation_detail = problem.what();
        }
    }
    say("validation layer", validation, validation_detail,
        "apt install vulkan-validationlayers (only tests and --validate need it)");

    Session session(arguments.plugins);
    Devices on;
    try {
        on = session.openDevices("", false);
    } catch (const DeviceError&) { // said above
    }
    for (const std::string& name : session.traceBackends().names()) {
        try {
            const TraceCaps caps = session.traceBackends().create(name, on)->caps();
            say("trace backend", true,
                (caps.name == name ? "" : name + " stands for ") + caps.name + " " + caps.version +
                    " on " + caps.runs_on,
                "");
        } catch (const DeviceError& problem) {
            const std::string what = problem.what(); // often names it already
            say("trace backend", false, what.starts_with(name) ? what : name + ": " + what, "");
        }
    }
    for (const Plugin& plugin : session.plugins()) {
        const PluginInfo& info = plugin.info();
        std::string offers;
        for (const PluginInfo::Backend& backend : info.trace_backends)
            offers += (offers.empty() ? "trace backend " : ", trace backend ") + backend.name;
        for (const std::string& pass : info.passes)
            offers += (offers.empty() ? "pass " : ", pass ") + pass;
        say("plug-in", true,
            info.name + " " + info.version + " (" + info.license + ", built by " + info.build +
                ") from " + printable(info.file) + ": " + info.doc + " Offers " + offers,
            "");
    }
    for (const std::string& problem : session.pluginProblems())
        say("plug-in", false, problem, "");
    report["checks"] = checks;
    report["can_raster"] = can_raster;
    if (arguments.json)
        print(console.out, report);
    else
        console.out << (can_raster ? "hone can rasterise and trace here.\n"
                                   : "hone can trace but not rasterise here: graphs with a raster "
                                     "pass will not run.\n");
    return can_raster ? kOk : kNoDevice;
}

} // namespace hone::cli

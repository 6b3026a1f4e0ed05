// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan_tracer.h"

#include "hone/backends/backends.h"
#include "hone/backends/host/host_device.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <spdlog/sinks/ostream_sink.h>

#include <sstream>

namespace hone::test {
namespace {

/// What is logged at info and above while this lives.
class LogCapture {
public:
    LogCapture() : sink_(std::make_shared<spdlog::sinks::ostream_sink_st>(text_)) {
        level_ = logger().level();
        logger().sinks().push_back(sink_);
        logger().set_level(spdlog::level::info);
    }
    ~LogCapture() {
        logger().sinks().pop_back();
        logger().set_level(level_);
    }
    [[nodiscard]] std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::sinks::ostream_sink_st> sink_;
    spdlog::level::level_enum level_;
};

using VulkanChooser = VulkanTest;

TEST_F(VulkanChooser, TakesTheBestThatTheDeviceOffersAndSaysWhich) {
    const RayTracing offered = rayTracing(device());
    if (!offered.query && !offered.pipeline)
        GTEST_SKIP() << device().info().driver << " offers no ray tracing";
    const auto host = makeHostDevice();
    const LogCapture log;
    const std::string name =
        makeVulkanTracer({.host = host.get(), .raster = &device()})->caps().name;
    EXPECT_EQ(name, offered.query ? "vulkan.ray_query" : "vulkan.ray_pipeline");
    EXPECT_NE(log.text().find(name + " on " + device().info().name), std::string::npos)
        << log.text();
}

TEST_F(VulkanChooser, HasComputeWhereTheDeviceOffersNothing) {
    VulkanOptions plain = options();
    plain.ray_tracing = false;
    const auto device = makeVulkanDevice(plain);
    const auto host = makeHostDevice();
    const LogCapture log;
    EXPECT_EQ(makeVulkanTracer({.host = host.get(), .raster = device.get()})->caps().name,
              "vulkan.compute");
    EXPECT_NE(log.text().find("offers neither ray query nor ray pipeline"), std::string::npos)
        << log.text();
}

TEST(VulkanTracerNames, ThrowWhereThereIsNoVulkanDevice) {
    TraceBackendRegistry registry;
    registerTraceBackends(registry);
    const auto host = makeHostDevice();
    for (const char* name :
         {"vulkan", "vulkan.ray_query", "vulkan.ray_pipeline", "vulkan.compute"}) {
        ASSERT_TRUE(registry.contains(name));
        try {
            (void)registry.create(name, {.host = host.get()});
            FAIL() << name;
        } catch (const DeviceError& error) {
            EXPECT_TRUE(
                std::string(error.what()).starts_with(std::string(name) + " needs a Vulkan device"))
                << error.what();
        }
    }
}

} // namespace
} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/choice/backend_name.h"

#include "hone/core/graph/diagnostics.h"
#include "hone/core/trace/check/check_backend.h"
#include "hone/core/trace/null_backend.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hone {
namespace {

TraceBackendRegistry twoBackends() {
    TraceBackendRegistry registry;
    for (const char* name : {"embree", "vulkan"})
        registry.add(name, "", [](const Devices&) { return makeNullBackend(); });
    return registry;
}

TEST(BackendName, ReadsChecks) {
    EXPECT_EQ(parseCheckName("check(embree)")->first, "embree");
    EXPECT_EQ(parseCheckName("check(embree)")->second, "");
    EXPECT_EQ(parseCheckName("check(embree,vulkan.compute)")->second, "vulkan.compute");
    EXPECT_EQ(parseCheckName("check( embree , vulkan )")->first, "embree");
    EXPECT_EQ(parseCheckName("check( embree , vulkan )")->second, "vulkan");
    for (const char* other :
         {"embree", "check", "check(", "check()", "check( )", "check(,a)", "check(a,)",
          "check(a,b,c)", "check(check(a))", "check(a))", "checked(a)", "check(a) ", ""})
        EXPECT_FALSE(parseCheckName(other)) << other;
}

TEST(BackendName, SuggestsNamesOfTheSameForm) {
    const std::vector<std::string> names{"auto", "embree", "vulkan"};
    const auto meant = [&](const char* name) { return nearest(name, similarNames(name, names)); };
    EXPECT_EQ(meant("embre"), "embree");
    EXPECT_EQ(meant("check(embre)"), "check(embree)");
    EXPECT_EQ(meant("check(embree,vulcan)"), "check(embree,vulkan)");
    EXPECT_EQ(meant("check(embree"), "check(embree)");
    EXPECT_EQ(meant("check"), "");
}

TEST(TraceBackendRegistry, TakesChecksWhereItTakesNames) {
    const TraceBackendRegistry registry = twoBackends();
    for (const char* name : {"embree", "check(embree)", "check(vulkan,embree)", "check(auto)",
                             "check(embree,auto)", "check(embree, vulkan)"}) {
        EXPECT_TRUE(registry.contains(name)) << name;
        EXPECT_NE(registry.create(name, {}), nullptr) << name;
    }
    for (const char* name : {"check(embre)", "check(embree,vulcan)", "check()", "check(embree"}) {
        EXPECT_FALSE(registry.contains(name)) << name;
        EXPECT_THROW(std::ignore = registry.create(name, {}), std::logic_error) << name;
    }
    EXPECT_EQ(registry.create("check(embree,vulkan)", {})->caps().name, "check(null,null)");
}

TEST(TraceBackendRegistry, WrapsEachBackendOnce) {
    TraceBackendRegistry registry = twoBackends();
    int wrapped = 0;
    registry.wrapEach([&](std::unique_ptr<TraceBackend> backend) {
        ++wrapped;
        return backend;
    });
    EXPECT_NE(registry.create("embree", {}), nullptr);
    EXPECT_EQ(wrapped, 1);
    EXPECT_NE(registry.create("check(embree,vulkan)", {}), nullptr);
    EXPECT_EQ(wrapped, 2);
}

TEST(TraceBackendRegistry, GathersWhatItsChecksFind) {
    TraceBackendRegistry registry = twoBackends();
    CheckReport report;
    registry.reportChecksTo(report);
    const Scene scene;
    const auto checked = registry.create("check(embree)", {});
    checked->build(scene);
    const Ray ray{{0, 0, 0}, 0, {0, 0, 1}, 1};
    Hit hit{};
    checked->closest({&ray, 1}, {&hit, 1}, Coherence::kCoherent, {});
    EXPECT_EQ(report.closest.rays, 1u);
}

} // namespace
} // namespace hone

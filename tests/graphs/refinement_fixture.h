// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/executor.h"
#include "hone/tests/support/vulkan_fixture.h"

#include <memory>
#include <string>
#include <vector>

namespace hone {

/// Shipped graphs on small pictures of a scene, with Embree.
class RefinementTest : public VulkanTest {
protected:
    static constexpr uvec2 kExtent{64, 48};

    /// Registers passes and tracers and opens "builtin:" `scene` through its first camera.
    void open(const std::string& scene);

    [[nodiscard]] std::unique_ptr<Executor> load(const std::string& graph,
                                                 const Overrides& overrides = {});

    /// Runs, and copies the output "color".
    [[nodiscard]] static std::vector<vec3> colorOf(Executor& executor,
                                                   const RunOptions& options = {});

    /// How many pixels differ in a bit, and the first of them.
    [[nodiscard]] static testing::AssertionResult areSameBits(const std::vector<vec3>& a,
                                                              const std::vector<vec3>& b);

    /// How often the node ran since the executor was made.
    [[nodiscard]] static std::uint64_t runsOf(const Executor& executor, const std::string& node);

    PassRegistry passes_;
    TraceBackendRegistry tracers_;
    std::unique_ptr<Device> host_;
    Scene scene_;
    Camera camera_{};
};

} // namespace hone

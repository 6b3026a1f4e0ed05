// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/host/host_device.h"
#include "hone/core/graph/executor.h"
#include "hone/tests/support/test_passes.h"

#include <gtest/gtest.h>

#include <string>

namespace hone {

/// Graphs of test passes (test_passes.h) that run on the host.
class GraphTest : public testing::Test {
protected:
    GraphTest() {
        scene.version = 1;
        camera.position = {10, 0, 0};
        host = makeHostDevice();
    }

    /// Compiles; any problem fails the test.
    [[nodiscard]] CompiledGraph plan(const std::string& text, const Overrides& overrides = {}) {
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraph("test.json", text, diagnostics);
        CompiledGraph graph = compile(desc, catalog.catalog(), overrides, diagnostics);
        EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
        return graph;
    }

    /// A graph of tests/core/graph/plans.
    [[nodiscard]] static std::string planFile(const std::string& name);

    /// An executor with scene, camera (x = 10) and 5 x 2 pixels.
    [[nodiscard]] std::unique_ptr<Executor> start(const std::string& text,
                                                  const Overrides& overrides = {}) {
        return start(plan(text, overrides));
    }
    [[nodiscard]] std::unique_ptr<Executor> start(CompiledGraph graph) {
        auto executor = std::make_unique<Executor>(std::move(graph), catalog.catalog(),
                                                   Devices{host.get(), raster}, 7);
        executor->setScene(scene);
        executor->setCamera(camera);
        executor->setExtent({5, 2});
        return executor;
    }

    [[nodiscard]] static std::uint64_t runs(const Executor& executor, const std::string& node) {
        for (const NodeReport& report : executor.nodes())
            if (report.name == node)
                return report.runs;
        ADD_FAILURE() << "no node " << node;
        return 0;
    }

    TestCatalog catalog;
    Scene scene;
    Camera camera{};
    std::unique_ptr<Device> host;
    Device* raster = nullptr; ///< set before start()
};

} // namespace hone

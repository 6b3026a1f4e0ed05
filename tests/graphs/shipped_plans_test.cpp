// SPDX-License-Identifier: Apache-2.0
//
// What the compiler makes of every shipped graph, beside what it made of it before: a change of
// order, of what shares memory or of what is copied shows as a changed line. With HONE_WRITE_PLANS
// set the files are written instead; read the difference before committing it.
#include "hone/backends/backends.h"
#include "hone/core/graph/compiled_graph.h"
#include "hone/passes/passes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace hone {
namespace {

const std::filesystem::path kPlans = HONE_SOURCE_DIR "/tests/graphs/plans";

std::vector<std::string> shippedGraphs() {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(HONE_SOURCE_DIR "/graphs"))
        if (file.path().extension() == ".json" && !file.path().string().ends_with(".schema.json"))
            names.push_back(file.path().stem().string());
    std::ranges::sort(names);
    return names;
}

std::string textOf(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {(std::istreambuf_iterator<char>(file)), {}};
}

class ShippedPlans : public testing::TestWithParam<std::string> {};

TEST_P(ShippedPlans, AreAsWrittenDown) {
    PassRegistry passes;
    registerPasses(passes);
    TraceBackendRegistry tracers;
    registerTraceBackends(tracers);
    const std::string plan =
        dump(loadGraph(HONE_SOURCE_DIR "/graphs/" + GetParam() + ".json", {&passes, &tracers}, {}),
             {800, 600});
    const std::filesystem::path path = kPlans / (GetParam() + ".plan");
    if (std::getenv("HONE_WRITE_PLANS") != nullptr)
        std::ofstream(path) << plan;
    EXPECT_EQ(plan, textOf(path)) << "if that is meant: HONE_WRITE_PLANS=1 hone_tests_graphs "
                                     "--gtest_filter='*ShippedPlans*', and read git diff";
}

INSTANTIATE_TEST_SUITE_P(All, ShippedPlans, testing::ValuesIn(shippedGraphs()),
                         [](const auto& test) { return test.param; });

TEST(ShippedPlansFolder, HasNoPlanOfAGraphThatIsGone) {
    const std::vector<std::string> graphs = shippedGraphs();
    for (const auto& file : std::filesystem::directory_iterator(kPlans))
        EXPECT_NE(std::ranges::find(graphs, file.path().stem().string()), graphs.end())
            << file.path();
}

} // namespace
} // namespace hone

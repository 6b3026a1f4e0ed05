// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/explain_value.h"
#include "hone/core/error.h"

#include <gtest/gtest.h>

#include <sstream>

namespace hone::cli {
namespace {

std::string explained(const std::string& graph, const std::string& name) {
    std::ostringstream out, err;
    explainValue(graph, name, {}, {}, {out, err});
    return out.str();
}

TEST(ExplainValue, SpeaksOfShippedGraphs) {
    const std::string text = explained("sir", "refine.blend.image");
    EXPECT_NE(text.find("updates refine.image where it lies"), std::string::npos) << text;
}

TEST(ExplainValue, KnowsTheOutputsOfGraphsThatAreUsedAsPasses) {
    EXPECT_EQ(explained("dof", "refine.image"), explained("dof", "refine.loop.image"));
    EXPECT_EQ(explained("table1", "dof.color"), explained("table1", "dof.refine.loop.image"));
}

TEST(ExplainValue, OffersTheNearestName) {
    try {
        explained("sir", "refine.blend.imag");
        FAIL() << "it knows no such value";
    } catch (const GraphError& problem) {
        EXPECT_NE(std::string(problem.what()).find("did you mean \"refine.blend.image\"?"),
                  std::string::npos)
            << problem.what();
    }
}

} // namespace
} // namespace hone::cli

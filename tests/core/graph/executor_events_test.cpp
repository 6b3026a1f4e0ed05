// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/graph_fixture.h"

#include <algorithm>

namespace hone {
namespace {

class ExecutorEvents : public GraphTest {
protected:
    struct Seen {
        std::string node;
        uint iteration;
        friend bool operator==(const Seen&, const Seen&) = default;
    };
    std::vector<Seen> run(Executor& executor) {
        std::vector<Seen> seen;
        RunOptions options;
        options.on_pass = [&](const PassEvent& event) {
            seen.push_back({executor.graph().nodes[event.node].name, event.iteration});
        };
        executor.run(options);
        return seen;
    }
};

TEST_F(ExecutorEvents, TellOfEachExecutionInOrderAndOfLoopsAfterTheirPasses) {
    const auto executor = start(planFile("shared_memory.json"));
    std::vector<Seen> expected{{"raster", 0}};
    for (uint i = 1; i <= 3; ++i)
        for (const char* pass : {"a", "b", "c", "d", "constant", "last"})
            if (pass != std::string_view("constant") || i == 1)
                expected.push_back({std::string("repeat.") + pass, i});
    expected.push_back({"repeat", 0});
    EXPECT_EQ(run(*executor), expected);
}

TEST_F(ExecutorEvents, AreNoneWhereNothingChanged) {
    const auto executor = start(planFile("refinement.json"));
    EXPECT_FALSE(run(*executor).empty());
    EXPECT_TRUE(run(*executor).empty());
}

TEST_F(ExecutorEvents, LastFromBeginToEndWithinEachOther) {
    const auto executor = start(planFile("nested_loops.json"));
    std::vector<PassEvent> events;
    RunOptions options;
    options.on_pass = [&](const PassEvent& event) { events.push_back(event); };
    executor->run(options);
    const auto of = [&](const char* name) {
        return *std::ranges::find_if(events, [&](const PassEvent& event) {
            return executor->graph().nodes[event.node].name == name;
        });
    };
    const PassEvent outer = of("outer");
    const PassEvent inner = of("outer.inner");
    for (const PassEvent& event : events) {
        EXPECT_LE(event.begin, event.end);
        EXPECT_TRUE(event.is_whole);
    }
    EXPECT_LE(outer.begin, inner.begin);
    EXPECT_GE(outer.end, inner.end);
    EXPECT_EQ(inner.iteration, 1u);
}

// a and c share memory: each is as its pass left it, at the moment it is told of. The image is the
// camera's 10 at first; a, b, c add 1 each, d does, and last adds the constant 11.
TEST_F(ExecutorEvents, ShowValuesBeforeOthersTakeTheirMemory) {
    const auto executor = start(planFile("shared_memory.json"));
    std::vector<float> a, c;
    RunOptions options;
    options.on_pass = [&](const PassEvent& event) {
        const std::string& name = executor->graph().nodes[event.node].name;
        if (name == "repeat.a")
            a.push_back(event.outputs[0].value->as<vec3>()[9].x);
        if (name == "repeat.c")
            c.push_back(event.outputs[0].value->as<vec3>()[9].x);
    };
    executor->run(options);
    EXPECT_EQ(a, (std::vector<float>{11, 26, 41}));
    EXPECT_EQ(c, (std::vector<float>{13, 28, 43}));
}

} // namespace
} // namespace hone

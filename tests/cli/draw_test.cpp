// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/cli/draw_dot.h"
#include "hone/tests/cli/command_run.h"
#include "hone/tests/support/graph_fixture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace hone::cli {
namespace {

std::string textOf(const std::string& path) {
    std::ifstream file(path);
    return {(std::istreambuf_iterator<char>(file)), {}};
}

bool hasDot() {
    return std::system("dot -V > /dev/null 2>&1") == 0;
}

class ToDot : public GraphTest {
protected:
    static void expectIn(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << "no " << part << " in\n" << text;
    }
};

// Nodes are numbered in the order of the file: sort 0, combine 1, raster 2, a 3, b 4, unused 5,
// unused_too 6, refine 7, its blend 8, request 9, trace 10, nobody 11.
TEST_F(ToDot, JoinsPortsAsTheGraphDoes) {
    const std::string text = toDot(plan(planFile("refinement.json")), {.times = {}});
    expectIn(text, "n2:o1:s -> n3:i0:n ["); // raster.depth -> a.depth
    expectIn(text, "n3:o0:s -> n1:i0:n [color=\"#c0453b\", tooltip=\"a.error: Error\", "
                   "fontcolor=\"#7b8794\", label=\" weight 0.5\"]");
    expectIn(text, "<B>combine</B>");
    expectIn(text, "Radiance, 5.76 MB");
}

TEST_F(ToDot, PutsLoopsIntoBoxesWithoutAnEdgeThatGoesBack) {
    const std::string text = toDot(plan(planFile("refinement.json")), {.times = {}});
    expectIn(text, "subgraph cluster_7 {");
    expectIn(text, "n2:o0:s -> n7_begin:c0:n"); // raster.color is what image begins with
    expectIn(text, "n7_begin:c0:s -> n8:i0:n"); // ~image -> blend.image
    expectIn(text, "n8:o0:s -> n7_end:c0:n");   // blend.image is the next image
    expectIn(text, "n7_end:r0:s -> out0:i:n");  // refine.image is the output color
    expectIn(text, "again, until refine.request.requests is empty or 100000 iterations");
}

TEST_F(ToDot, ShowsCulledPassesGreyWithTheReason) {
    const std::string text = toDot(plan(planFile("refinement.json")), {.times = {}});
    expectIn(text, "not run: nothing reads its outputs");
    expectIn(text, "STYLE=\"ROUNDED,DASHED\" COLOR=\"#b8c0c8\"");
    expectIn(text, "style=dashed");
}

TEST_F(ToDot, ShowsTimesWhereThereAreSome) {
    const CompiledGraph graph = plan(planFile("refinement.json"));
    const NodeReport times[] = {
        {.name = "sort", .type = "sort", .runs = 1, .ms = 4, .where = "host"},
        {.name = "refine.trace", .type = "trace", .runs = 3, .ms = 1, .where = "host"}};
    const std::string text = toDot(graph, {.times = times});
    expectIn(text, "4.00 ms, host");
    expectIn(text, "1.00 ms, 3 runs, host");
    expectIn(text, "BGCOLOR=\"#ffc878\""); // the slowest is the warmest: (255, 255 - 55, 255 - 135)
}

TEST_F(ToDot, LetsNoNameBecomeMarkup) {
    std::string text = planFile("shared_memory.json");
    const std::string name = R"("name": "shared_memory")";
    text.replace(text.find(name), name.size(), R"("name": "<b>&\"\\\n\u00e9")");
    const std::string dot = toDot(plan(text), {.times = {}});
    EXPECT_EQ(dot.find("<b>"), std::string::npos);
    expectIn(dot, "&lt;b&gt;&amp;&quot;&#92;???");
}

TEST(Draw, WritesDotToStandardOutput) {
    const CommandRun run = runHone({"draw", "prt"});
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_TRUE(run.out.starts_with("digraph hone {"));
    EXPECT_TRUE(run.out.ends_with("}\n"));
}

TEST(Draw, PutsGraphsThatAreUsedAsPassesIntoBoxes) {
    const CommandRun run = runHone({"draw", "table1"});
    EXPECT_EQ(run.code, kOk) << run.err;
    const std::size_t dof = run.out.find("subgraph cluster_graph_0 {");
    const std::size_t refine = run.out.find("subgraph cluster_graph_1 {");
    ASSERT_NE(refine, std::string::npos) << run.out;
    EXPECT_LT(dof, run.out.find("<B>shadow_map</B>"));
    EXPECT_LT(run.out.find("<B>shadow_map</B>"), refine); // which is inside, and last
    EXPECT_LT(refine, run.out.find("<B>loop</B>"));
    EXPECT_NE(run.out.find(">parts/refine.json<"), std::string::npos) << run.out;
}

TEST(Draw, WritesAPictureThroughGraphviz) {
    if (!hasDot())
        GTEST_SKIP() << "Graphviz' dot is not installed";
    const TemporaryFolder folder;
    for (const char* graph : {"sir", "figure10"}) {
        const CommandRun run = runHone({"draw", graph, "-o", folder.path("graph.svg")});
        ASSERT_EQ(run.code, kOk) << run.err;
        EXPECT_NE(textOf(folder.path("graph.svg")).find("<svg"), std::string::npos);
    }
}

TEST(Draw, ShowsTimesOfOneRun) {
    const CommandRun run = runHone({"draw", "prt", "--times", "--scene", "builtin:cornell",
                                    "--size", "8x8", "--device", "none"});
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_NE(run.out.find(" runs, host"), std::string::npos) << run.out;
}

TEST(Draw, RefusesWhatItCannotWriteBeforeItDraws) {
    const CommandRun ending = runHone({"draw", "prt", "-o", "graph.jpeg"});
    EXPECT_EQ(ending.code, kNotWritten);
    EXPECT_NE(ending.err.find(".svg, .png, .pdf or .dot"), std::string::npos);
    EXPECT_EQ(runHone({"draw", "prt", "-o", "/proc/graph.dot"}).code, kNotWritten);
    EXPECT_EQ(runHone({"draw", "prt", "--scene", "builtin:cornell"}).code, kUsage);
}

TEST(Draw, SaysWhatToInstallWhereThereIsNoGraphviz) {
    const TemporaryFolder folder;
    const std::string path = std::getenv("PATH");
    ASSERT_EQ(setenv("PATH", folder.path().c_str(), 1), 0);
    const CommandRun run = runHone({"draw", "prt", "-o", folder.path("graph.svg")});
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(run.code, kNotWritten);
    EXPECT_NE(run.err.find("apt-get install graphviz"), std::string::npos) << run.err;
}

} // namespace
} // namespace hone::cli

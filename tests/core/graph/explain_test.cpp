// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/explain.h"

#include "hone/tests/support/graph_fixture.h"

namespace hone {
namespace {

class Explain : public GraphTest {
protected:
    std::string of(const char* file, const char* name, const Overrides& overrides = {}) {
        return explain(plan(planFile(file), overrides), name).value_or("(unknown)");
    }
    static void expectLine(const std::string& text, const std::string& line) {
        EXPECT_NE(text.find(line), std::string::npos) << "no \"" << line << "\" in\n" << text;
    }
};

TEST_F(Explain, TellsAllOfAValueThatIsUpdatedInPlace) {
    const std::string text = of("refinement.json", "refine.blend.image");
    expectLine(text, "refine.blend.image: Radiance (vec3");
    expectLine(text,
               "\n  written by   refine.blend (blend) at step 9, in the iterations of refine\n");
    expectLine(text, "\n  read by      loop refine, which carries it on as refine.image\n");
    expectLine(text, "\n  needed       from step 9 to step 10\n");
    expectLine(text,
               "\n  memory       7, 12 B a pixel, shared with refine.image (steps 6 to end)\n");
    expectLine(text,
               "\n  in place     refine.blend updates refine.image where it lies: nothing else "
               "reads that any more\n");
}

TEST_F(Explain, TellsWhyAPassIsCulledDownToTheLastReason) {
    expectLine(of("refinement.json", "unused"),
               "does not run no output needs what reads it: \"unused_too\"; unused_too: nothing "
               "reads its outputs\n");
    expectLine(of("refinement.json", "unused.result"),
               "not made     no output needs what reads it: \"unused_too\"");
    expectLine(of("refinement.json", "refine.forgotten"), "not made");
}

TEST_F(Explain, TellsWhatAPassWaitsForAndWhyItIsWhereItIs) {
    const std::string combine = of("refinement.json", "combine");
    expectLine(combine, "\n  runs         at step 4\n");
    expectLine(combine,
               "\n  waits for    a (step 2), which writes a.error; b (step 3), which writes "
               "b.error\n");
    expectLine(combine, "\n  why there    right after b, the last that it waits for\n");
    const std::string b = of("refinement.json", "b");
    expectLine(b, "\n  why there    it could run earlier; of passes that could run next, the first "
                  "in the file does, which was a\n");
    expectLine(of("refinement.json", "raster"),
               "it waits for nothing, and of such passes it stands first in the file");
}

TEST_F(Explain, TellsWhereAPassRunsAndWhenAgain) {
    expectLine(of("refinement.json", "a"), "on the host, as the graph says");
    expectLine(of("refinement.json", "b"), "it has code for both");
    expectLine(of("refinement.json", "sort"), "on the host: it has no code for a device");
    expectLine(of("refinement.json", "sort"),
               "only when an input, a parameter or the image's size");
    expectLine(of("refinement.json", "refine.blend"), "in every iteration, changed or not");
}

TEST_F(Explain, TellsWhyAValueIsCopiedBeforeItIsUpdated) {
    // outer.sum still reads the image that outer.up is to update.
    expectLine(of("nested_loops.json", "outer.up.result"),
               "copied       outer.up updates a copy of outer.image: it is still read by outer.sum "
               "as b at step 7\n");
    expectLine(
        of("nested_loops.json", "after.result"),
        "copied       after updates a copy of outer.image: outside loops passes run only when "
        "something changed");
    const std::string x = of("nested_loops.json", "outer.inner.x");
    expectLine(x, "copied       outer.up.result when outer.inner begins");
    expectLine(x, "outer.inner.y after each iteration");
    expectLine(x, "through scratch memory: another carried value's copy would overwrite it");
}

TEST_F(Explain, TellsWhyAValueSharesItsMemoryOrDoesNot) {
    expectLine(of("shared_memory.json", "repeat.c.result"),
               "shared with repeat.a.result (steps 3 to 4), repeat.d.result (steps 6 to 8)");
    expectLine(of("shared_memory.json", "repeat.constant.result"),
               "its own: it does not change while repeat iterates, so it is made once and kept");
    expectLine(of("shared_memory.json", "repeat.b.result"), "its own: it is read after the loop");
    expectLine(of("shared_memory.json", "repeat.image"),
               "its own: a carried value keeps its memory");
    expectLine(of("shared_memory.json", "raster.color"), "its own: outside loops a value is kept");
    expectLine(of("shared_memory.json", "repeat.a.result"), "gone after the loop");
}

TEST_F(Explain, TellsOfLoopsInputsAndOutputs) {
    const std::string loop = of("refinement.json", "refine");
    expectLine(loop, "refine: loop\n");
    expectLine(loop, "carries      refine.image\n");
    expectLine(loop, "refine.forgotten (not carried: no output needs it)");
    expectLine(of("refinement.json", "$camera"), "nobody: it is an input of the graph");
    expectLine(of("refinement.json", "before"), "output       \"before\" of the graph");
    expectLine(of("refinement.json", "raster.color"),
               "loop refine, which begins with it as refine.image");
}

TEST_F(Explain, TellsOfTheLastFrameAndOfSwitches) {
    expectLine(of("last_frame.json", "sum.color@-1"),
               "written by   the last frame, at whose end sum.color is copied; in the first it is "
               "raster.color\n");
    expectLine(of("last_frame.json", "sum.color"),
               "\n               the next frame, as sum.color@-1\n");
    expectLine(of("last_frame.json", "more"), "does not run switched off: brighter is false\n");
    expectLine(of("last_frame.json", "more", {{"brighter", "true"}}), "runs         at step 3\n");
}

TEST_F(Explain, KnowsEveryNameItOffersAndNoOther) {
    for (const char* file :
         {"refinement.json", "shared_memory.json", "nested_loops.json", "last_frame.json"}) {
        const CompiledGraph graph = plan(planFile(file));
        for (const std::string& name : explainable(graph)) {
            const auto text = explain(graph, name);
            ASSERT_TRUE(text) << name;
            EXPECT_TRUE(text->ends_with('\n')) << name;
            EXPECT_EQ(text->find("  \n"), std::string::npos) << *text;
        }
        EXPECT_FALSE(explain(graph, "nothing.like_it"));
    }
}

} // namespace
} // namespace hone

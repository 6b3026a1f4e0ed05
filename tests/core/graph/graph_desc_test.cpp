// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/tests/support/graph_fixture.h"

#include <algorithm>
#include <filesystem>

namespace hone {
namespace {

class GraphDescTest : public GraphTest {};

SourceText::Position positionOf(const GraphDesc& desc, const Place& place) {
    return desc.source->locate(place.span.begin);
}

TEST_F(GraphDescTest, KnowsWhereEveryWordIsWritten) {
    const std::string text =
        "\xEF\xBB\xBF{ // a comment with \"quotes\", commas: and [brackets]\r\n"
        "  \"hone\" /* here */ : 1,\r\n"
        "  \"passes\": { \"a\": { \"type\": \"add\",\r\n"
        "    \"in\": { \"color\": \"b\\u002ec\\\"\" }, \"params\": { \"amount\":-1.5e0} } },\r\n"
        "  \"outputs\": {}\r\n}";
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph("x.json", text, diagnostics);
    ASSERT_TRUE(diagnostics.empty()) << format(diagnostics);
    const PassDesc& pass = desc.passes.at(0);
    EXPECT_EQ(positionOf(desc, pass.name.place).line, 3u);
    EXPECT_EQ(positionOf(desc, pass.name.place).column, 15u);
    EXPECT_EQ(pass.type.place.span.length, 5u);
    const EdgeDesc& edge = pass.inputs.at(0).edges.at(0);
    EXPECT_EQ(edge.from.text, "b.c\"");
    EXPECT_EQ(positionOf(desc, edge.from.place).line, 4u);
    EXPECT_EQ(positionOf(desc, edge.from.place).column, 22u);
    EXPECT_EQ(edge.from.place.span.length, 12u);
    EXPECT_EQ(edge.from.place.pointer, "/passes/a/in/color");
    const ParamText& amount = pass.params.at(0);
    EXPECT_EQ(std::get<double>(amount.value), -1.5);
    EXPECT_EQ(amount.place.span.length, 6u);
    EXPECT_EQ(positionOf(desc, amount.place).column, 59u);
}

std::string firstCode(const std::string& text) {
    std::vector<Diagnostic> diagnostics;
    (void)parseGraph("x.json", text, diagnostics);
    return diagnostics.empty() ? "" : diagnostics.front().code;
}

TEST_F(GraphDescTest, HoldsItsLimits) {
    EXPECT_EQ(firstCode(std::string((std::size_t{16} << 20) + 1, ' ')), "E0104");
    std::string many = "{ \"hone\": 1, \"passes\": [";
    for (int i = 0; i < 262144; ++i)
        many += "0,";
    EXPECT_EQ(firstCode(many + "0] }"), "E0104");
    std::string passes = "{ \"hone\": 1, \"passes\": { \"a\": {}";
    for (int i = 0; i < 4096; ++i)
        passes += ", \"p" + std::to_string(i) + "\": {}";
    std::vector<Diagnostic> diagnostics;
    (void)parseGraph("x.json", passes + "} }", diagnostics);
    EXPECT_EQ(diagnostics.size(), 100u) << "nobody reads more";
}

TEST_F(GraphDescTest, SaysWhenTheFileCannotBeRead) {
    for (const std::string& path :
         {std::string("no/such/file.json"), std::filesystem::temp_directory_path().string()}) {
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraphFile(path, diagnostics);
        ASSERT_EQ(diagnostics.size(), 1u);
        EXPECT_EQ(diagnostics[0].code, "E0106");
        EXPECT_FALSE(desc.is_readable);
        EXPECT_THROW((void)loadGraph(path, catalog.catalog(), {}), GraphError);
    }
}

/// Every report must be printable and have a place that exists.
void expectGoodReports(const std::string& text, const Catalog& catalog) {
    std::vector<Diagnostic> diagnostics;
    const GraphDesc desc = parseGraph("x.json", text, diagnostics);
    const CompiledGraph graph = compile(desc, catalog, {}, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics) {
        EXPECT_EQ(diagnostic.code.size(), 5u);
        if (diagnostic.line != 0) {
            EXPECT_LE(diagnostic.column, desc.source->line(diagnostic.line).size() + 1) << text;
            EXPECT_LE(diagnostic.source_column, diagnostic.source.size() + 1) << text;
        }
        EXPECT_FALSE(format(diagnostic).empty());
    }
    if (diagnostics.empty()) {
        EXPECT_FALSE(dump(graph).empty());
    }
}

TEST_F(GraphDescTest, PointsBelowTheExcerptWhereALineEndsWithACarriageReturn) {
    std::vector<Diagnostic> diagnostics;
    (void)parseGraph("x.json", "\r", diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].source, "");
    EXPECT_EQ(diagnostics[0].source_column, 1u);
}

TEST_F(GraphDescTest, SurvivesEveryTruncation) {
    for (const char* name : {"refinement.json", "nested_loops.json"}) {
        const std::string text = planFile(name);
        for (std::size_t length = 0; length < text.size(); ++length)
            expectGoodReports(text.substr(0, length), catalog.catalog());
    }
}

TEST_F(GraphDescTest, SurvivesEveryChangedByte) {
    for (const char* name : {"refinement.json", "nested_loops.json"}) {
        const std::string text = planFile(name);
        for (std::size_t at = 0; at < text.size(); ++at)
            for (const char byte :
                 {'"', '{', '}', ',', '~', '$', '.', '0', 'x', '\n', '\0', '\xff'}) {
                std::string changed = text;
                changed[at] = byte;
                expectGoodReports(changed, catalog.catalog());
            }
    }
}

TEST_F(GraphDescTest, SurvivesWordsInOthersPlaces) {
    // Exchange every pair of strings of a graph: meanings break where syntax does not.
    const std::string text = planFile("nested_loops.json");
    std::vector<std::pair<std::size_t, std::size_t>> words;
    for (std::size_t at = text.find("\"hone\""); (at = text.find('"', at)) != std::string::npos;) {
        const std::size_t end = text.find('"', at + 1);
        words.emplace_back(at, end - at + 1);
        at = end + 1;
    }
    for (std::size_t i = 0; i < words.size(); ++i)
        for (std::size_t j = i + 1; j < words.size(); ++j) {
            std::string changed = text;
            const std::string first = text.substr(words[i].first, words[i].second);
            const std::string second = text.substr(words[j].first, words[j].second);
            changed.replace(words[j].first, words[j].second, first);
            changed.replace(words[i].first, words[i].second, second);
            expectGoodReports(changed, catalog.catalog());
        }
}

TEST(Nearest, FindsWhatWasMeant) {
    const std::vector<std::string> words{"error.shadow", "error.reflection", "combine", "sort"};
    EXPECT_EQ(nearest("eror.shadow", words), "error.shadow");
    EXPECT_EQ(nearest("Combine", words), "combine");
    EXPECT_EQ(nearest("osrt", words), "sort");
    EXPECT_EQ(nearest("refine", words), "");
    EXPECT_EQ(nearest("", words), "");
    // One edit for every three letters begun.
    EXPECT_EQ(nearest("srt", words), "sort");
    EXPECT_EQ(nearest("srq", words), "");
    EXPECT_EQ(nearest("rasta", {"raster"}), "raster");
    EXPECT_EQ(nearest("cmbie", words), "combine");
    // Half of the letters may be wrong, but not the first.
    EXPECT_EQ(nearest("srtt", {"sort"}), "sort");
    EXPECT_EQ(nearest("soap", {"sort"}), "sort");
    EXPECT_EQ(nearest("form", {"sort"}), "");
    EXPECT_EQ(nearest("cbine", {"combined"}), "");
    // "in" is one edit away, too, but keeps less of what was typed.
    EXPECT_EQ(nearest("mi", {"in", "min"}), "min");
    EXPECT_EQ(nearest("mox", {"mix", "max"}), "mix");
}

TEST(GraphTypes, AreHonesAndThePasses) {
    PassRegistry registry;
    constexpr PortType kHeat{"Heat", Shape::kPlane, 4, "float, kelvin"};
    registry.add(PassType("heat", "Heats").out("heat", kHeat, "how hot"));
    const std::vector<PortType> all = graphTypes(registry);
    EXPECT_EQ(all.size(), std::size(types::kAll) + 1);
    EXPECT_NE(std::ranges::find(all, "Heat", &PortType::name), all.end());
    EXPECT_TRUE(std::ranges::is_sorted(all, {}, &PortType::name));
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/backends.h"
#include "hone/cli/commands.h"
#include "hone/cli/graph_schema.h"
#include "hone/cli/json.h"
#include "hone/passes/passes.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <sstream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string read(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// hone's own passes and backends, without any plug-in.
struct OwnCatalog {
    OwnCatalog() {
        registerPasses(passes);
        registerTraceBackends(tracers);
    }
    [[nodiscard]] Catalog catalog() const { return {&passes, &tracers}; }
    PassRegistry passes;
    TraceBackendRegistry tracers;
};

std::vector<std::filesystem::path> shippedGraphs() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(HONE_SOURCE_DIR "/graphs"))
        if (entry.path().extension() == ".json" && !entry.path().string().ends_with(".schema.json"))
            files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

TEST(Schema, ThatIsShippedIsCurrent) {
    const OwnCatalog own;
    std::ostringstream text;
    print(text, graphSchema(own.catalog()));
    EXPECT_TRUE(read(HONE_SOURCE_DIR "/graphs/hone-graph.schema.json") == text.str())
        << "run: hone schema > graphs/hone-graph.schema.json";
}

TEST(Schema, IsNamedByEveryShippedGraph) {
    for (const std::filesystem::path& file : shippedGraphs())
        EXPECT_EQ(Json::parse(read(file), nullptr, true, true)["$schema"], "hone-graph.schema.json")
            << file;
}

TEST(Schema, DescribesTypesPortsAndParameters) {
    const OwnCatalog own;
    const Json schema = graphSchema(own.catalog());
    const Json& typed = schema["definitions"]["typed_pass"];
    const Json& types = typed["properties"]["type"]["enum"];
    EXPECT_EQ(types.size(), own.passes.all().size() + 1); // and "glsl"
    EXPECT_EQ(types.size(), typed["properties"]["type"]["enumDescriptions"].size());

    const Json& sort = schema["definitions"]["pass.sort"];
    EXPECT_EQ(sort["required"], Json({"in"}));
    EXPECT_EQ(sort["properties"]["in"]["required"], Json({"error"}));
    const Json& strategy = sort["properties"]["params"]["properties"]["strategy"];
    EXPECT_EQ(strategy["default"], "select");
    EXPECT_EQ(strategy["anyOf"][0]["enum"], Json({"select", "radix"}));
    EXPECT_NE(strategy["description"], "");
    EXPECT_EQ(sort["properties"]["on"]["enum"].back(), "auto");
}

TEST(Schema, IsPrintedByTheCommand) {
    const CommandRun run = runHone({"schema"});
    EXPECT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(run.json()["$schema"], "http://json-schema.org/draft-07/schema#");
}

/// Changes the structure of a graph in one place.
class Mutator {
public:
    Mutator(unsigned seed, const std::vector<Json>& graphs) : random_(seed) {
        for (const Json& graph : graphs)
            collect(graph);
    }

    Json mutate(Json graph) {
        std::vector<Json*> places;
        listPlaces(graph, places);
        for (int attempt = 0; attempt < 100; ++attempt) {
            Json& place = *places[below(places.size())];
            if (change(place))
                return graph;
        }
        return graph;
    }

private:
    std::size_t below(std::size_t count) { return random_() % count; }

    void collect(const Json& value) {
        if (value.is_object())
            for (const auto& [key, member] : value.items())
                keys_.insert(key);
        if (value.is_primitive())
            values_.insert(value.dump());
        if (value.is_structured())
            for (const Json& member : value)
                collect(member);
    }

    void listPlaces(Json& value, std::vector<Json*>& places) {
        places.push_back(&value);
        if (value.is_structured())
            for (Json& member : value)
                listPlaces(member, places);
    }

    std::string anyKey() {
        return *std::next(keys_.begin(), static_cast<long>(below(keys_.size())));
    }
    Json anyValue() {
        return Json::parse(*std::next(values_.begin(), static_cast<long>(below(values_.size()))));
    }
    Json otherKind() {
        const Json kinds[] = {nullptr,
                              true,
                              3,
                              -1,
                              0.5,
                              1e300,
                              "",
                              "word",
                              Json::array(),
                              Json::object(),
                              Json::array({"a.b"}),
                              {{"from", "a.b"}}};
        return kinds[below(std::size(kinds))];
    }

    bool change(Json& place) {
        if (place.is_object() && below(2) == 0)
            return changeObject(place);
        if (place.is_array() && below(2) == 0)
            return changeArray(place);
        switch (below(5)) {
        case 0:
            place = otherKind();
            return true;
        case 1:
            place = anyValue();
            return true;
        case 2:
            place = Json::array({place});
            return true;
        case 3:
            return changeNumber(place);
        default:
            return changeText(place);
        }
    }

    bool changeObject(Json& object) {
        const std::size_t what = below(4);
        if (object.empty() || what == 3) {
            object[below(2) == 0 ? anyKey() : "unheard_of"] =
                below(2) == 0 ? anyValue() : otherKind();
            return true;
        }
        auto member = object.begin();
        std::advance(member, static_cast<long>(below(object.size())));
        const std::string key = member.key();
        const Json value = member.value();
        if (what == 0) {
            object.erase(key);
        } else if (what == 1) {
            object.erase(key);
            object[below(2) == 0 ? anyKey() : key + "x"] = value;
        } else {
            const std::string other = anyKey();
            object[other] = value;
        }
        return true;
    }

    bool changeArray(Json& array) {
        if (array.empty())
            return false;
        if (below(2) == 0) {
            array.erase(below(array.size()));
        } else {
            const std::size_t times = below(10);
            for (std::size_t i = 0; i < times; ++i)
                array.push_back(array[0]);
        }
        return true;
    }

    bool changeNumber(Json& number) {
        if (!number.is_number())
            return false;
        const double changed[] = {0, -1, 0.5, 1, 2, 5, 1e10, -1e300, 4294967296.0};
        number = changed[below(std::size(changed))];
        return true;
    }

    bool changeText(Json& text) {
        if (!text.is_string())
            return false;
        const std::string before = text.get<std::string>();
        const std::string changed[] = {
            "",           before + "x", "$" + before, "~" + before,   before + "@-1",
            before + ".", "a b",        "host",       "check(brute)", "trace_backends"};
        text = changed[below(std::size(changed))];
        return true;
    }

    std::mt19937 random_;
    std::set<std::string> keys_;
    std::set<std::string> values_; ///< as JSON
};

/// Is it in a pass that is another graph, whose ports and parameters a schema does not know?
bool isInGraphPass(std::string pointer, const Json& graph) {
    for (; !pointer.empty(); pointer.resize(pointer.rfind('/')))
        if (const Json::json_pointer at(pointer);
            graph.contains(at) && graph.at(at).contains("graph"))
            return true;
    return false;
}

/// Is it a problem of structure, which a schema can see? Not: whom a reference names, what a graph
/// parameter's value is where it is used, meanings, cycles, other files.
bool isStructural(const Diagnostic& diagnostic, const Json& graph) {
    static const std::set<std::string> kCodes{"E0201", "E0202", "E0203", "E0204", "E0205", "E0208",
                                              "E0301", "E0302", "E0307", "E0402", "E0403", "E0404",
                                              "E0501", "E0502", "E0503", "E0504", "E0507", "E0605",
                                              "E0611", "E0701", "E0702"};
    static const std::set<std::string> kOfPorts{"E0302", "E0402", "E0403", "E0501",
                                                "E0502", "E0503", "E0504"};
    const std::string& pointer = diagnostic.pointer;
    if (!kCodes.contains(diagnostic.code) || diagnostic.file != "mutant.json" ||
        (kOfPorts.contains(diagnostic.code) && isInGraphPass(pointer, graph)))
        return false;
    const bool is_value = graph.contains(Json::json_pointer(pointer));
    const Json value = is_value ? graph.at(Json::json_pointer(pointer)) : Json();
    const bool is_reference = value.is_string() && value.get<std::string>().starts_with('$');
    const bool is_default = pointer.starts_with("/params/") && pointer.ends_with("/default");
    if (diagnostic.code == "E0503" || diagnostic.code == "E0504")
        return !is_reference && !is_default && pointer.find("/when") == std::string::npos;
    if (diagnostic.code == "E0507") // "min" above "max"
        return pointer.ends_with("/type") || pointer.ends_with("/from");
    if (diagnostic.code == "E0605")
        return pointer.ends_with("/zero");
    return true;
}

/// The graphs' verdicts; nothing where node or ajv is not there.
std::vector<std::string> askAjv(const Json& schema, const Json& graphs) {
    const TemporaryFolder folder;
    const std::string schema_file = folder.write("schema.json", schema.dump());
    const std::string graph_file = folder.write("graphs.json", graphs.dump());
    const std::string command =
        "NODE_PATH=\"$NODE_PATH:$(npm root -g 2>/dev/null)\" node '" HONE_SOURCE_DIR
        "/tests/cli/schema_verdicts.js' '" +
        schema_file + "' '" + graph_file + "' > '" + folder.path("verdicts") + "' 2> '" +
        folder.path("problems") + "'";
    std::vector<std::string> verdicts;
    if (std::system(command.c_str()) != 0)
        return verdicts;
    std::istringstream lines(read(folder.path("verdicts")));
    for (std::string line; std::getline(lines, line);)
        verdicts.push_back(line);
    return verdicts;
}

TEST(Schema, AgreesWithTheBinderOnChangedGraphs) {
    const OwnCatalog own;
    std::vector<Json> graphs;
    for (const std::filesystem::path& file : shippedGraphs())
        graphs.push_back(Json::parse(read(file), nullptr, true, true));
    Json mutants = graphs;
    Mutator mutator(7, graphs);
    constexpr std::size_t kMutants = 3000;
    while (mutants.size() < graphs.size() + kMutants)
        mutants.push_back(mutator.mutate(graphs[mutants.size() % graphs.size()]));
    const std::vector<std::string> verdicts = askAjv(graphSchema(own.catalog()), mutants);
    if (verdicts.empty())
        GTEST_SKIP() << "needs node and its package ajv: npm install -g ajv, or NODE_PATH";
    ASSERT_EQ(verdicts.size(), mutants.size());

    const ReadFile files = filesBeside(HONE_SOURCE_DIR "/graphs/sir.json");
    std::map<std::string, int> found; // by code
    std::size_t good = 0, unseen = 0;
    for (std::size_t i = 0; i < mutants.size(); ++i) {
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraph("mutant.json", mutants[i].dump(1), diagnostics, files);
        (void)compile(desc, own.catalog(), {}, diagnostics);
        std::erase_if(diagnostics,
                      [](const Diagnostic& d) { return d.severity != Severity::kError; });
        const bool is_accepted = verdicts[i] == "ok";
        const bool must_refuse = std::ranges::any_of(
            diagnostics, [&](const Diagnostic& d) { return isStructural(d, mutants[i]); });
        good += diagnostics.empty();
        unseen += is_accepted && !diagnostics.empty();
        for (const Diagnostic& diagnostic : diagnostics)
            ++found[diagnostic.code];
        if (is_accepted ? must_refuse : diagnostics.empty())
            ADD_FAILURE() << "ajv: " << verdicts[i] << "\nhone: " << format(diagnostics);
    }
    std::cout << mutants.size() << " graphs: " << good << " good, " << mutants.size() - good
              << " bad, of which " << unseen << " in what a schema does not see\n";
    for (const auto& [code, count] : found)
        std::cout << code << " " << count << "\n";
    EXPECT_GE(good, 100u);
}

} // namespace
} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
//
// Shipped graphs with one or two letters wrong: is the place exact, and is what was meant suggested
// first?
#include "hone/backends/backends.h"
#include "hone/core/graph/compiled_graph.h"
#include "hone/core/graph/json_source.h"
#include "hone/passes/passes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <set>

namespace hone {
namespace {

/// A word of a graph file that must be one of several.
struct Word {
    std::size_t graph;
    std::size_t at; ///< of its first letter
    std::string text;
};

struct Graph {
    std::string file;
    std::string text;
};

/// All words of the shipped graphs by what they name. Names that the author is free to choose are
/// not among them: there the mistake shows where the name is used.
class Words {
public:
    Words() {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(HONE_SOURCE_DIR "/graphs"))
            if (entry.path().extension() == ".json" &&
                !entry.path().string().ends_with(".schema.json"))
                files.push_back(entry.path());
        std::ranges::sort(files);
        for (const std::filesystem::path& file : files) {
            std::vector<Diagnostic> diagnostics;
            const GraphDesc desc = parseGraphFile(file.string(), diagnostics);
            graphs.push_back({file.filename().string(), desc.source->text()});
            Reporter reporter(*desc.source, diagnostics);
            JsonValue root;
            if (parseJson(*desc.source, reporter, root))
                addGraph(root);
        }
    }

    std::vector<Graph> graphs;
    std::map<std::string, std::vector<Word>> by_kind;
    std::set<std::string> spellings; ///< of all words: another right word is no typo

private:
    void add(const char* kind, const TextSpan& span, const std::string& text) {
        by_kind[kind].push_back({graphs.size() - 1, span.begin + std::size_t{1}, text});
        spellings.insert(text);
    }
    void addKeys(const char* kind, const JsonValue& object) {
        for (const JsonMember& member : object.members)
            add(kind, member.key_span, member.key);
    }
    void addText(const char* kind, const JsonValue* value) {
        if (value != nullptr && value->kind == JsonValue::Kind::kString)
            add(kind, value->span, value->text);
    }
    static const JsonValue* find(const JsonValue& object, std::string_view key) {
        const JsonMember* member = object.find(key);
        return member != nullptr ? &member->value : nullptr;
    }
    static void forEach(const JsonValue* object,
                        const std::function<void(const JsonMember&)>& visit) {
        if (object != nullptr)
            for (const JsonMember& member : object->members)
                visit(member);
    }

    void addGraph(const JsonValue& root) {
        addKeys("key", root);
        forEach(find(root, "params"), [&](const JsonMember& param) {
            addKeys("key", param.value);
            addText("type", find(param.value, "type"));
            const JsonValue* fallback = find(param.value, "default");
            if (find(param.value, "choices") != nullptr)
                addText("choice", fallback);
        });
        forEach(find(root, "inputs"),
                [&](const JsonMember& input) { addText("type", &input.value); });
        addPasses(find(root, "passes"));
        forEach(find(root, "outputs"),
                [&](const JsonMember& output) { addText("reference", &output.value); });
    }

    void addPasses(const JsonValue* passes) {
        forEach(passes, [&](const JsonMember& pass) {
            addKeys("key", pass.value);
            addText("pass type", find(pass.value, "type"));
            forEach(find(pass.value, "in"), [&](const JsonMember& input) {
                add("port", input.key_span, input.key);
                addEdge(input.value);
            });
            forEach(find(pass.value, "params"), [&](const JsonMember& param) {
                add("parameter", param.key_span, param.key);
                addParam(param.value);
            });
            if (const JsonValue* loop = find(pass.value, "loop"))
                addLoop(*loop);
        });
    }

    void addLoop(const JsonValue& loop) {
        addKeys("key", loop);
        forEach(find(loop, "carry"), [&](const JsonMember& carry) {
            addText("reference", &carry.value);
            addKeys("key", carry.value);
            addText("type", find(carry.value, "zero"));
        });
        addPasses(find(loop, "passes"));
        forEach(find(loop, "next"), [&](const JsonMember& next) {
            add("carried", next.key_span, next.key);
            addText("reference", &next.value);
        });
        if (const JsonValue* stop = find(loop, "stop"))
            for (const JsonValue& rule : stop->elements) {
                addKeys("key", rule);
                addText("reference", find(rule, "empty"));
                for (const JsonMember& member : rule.members)
                    if (member.key != "empty")
                        addParam(member.value);
            }
    }

    void addEdge(const JsonValue& edge) {
        if (edge.kind == JsonValue::Kind::kString)
            addText(edge.text.starts_with('~') ? "carried" : "reference", &edge);
        for (const JsonValue& element : edge.elements)
            addEdge(element);
        for (const JsonMember& member : edge.members) {
            add(member.key == "from" ? "key" : "edge parameter", member.key_span, member.key);
            if (member.key == "from")
                addText("reference", &member.value);
        }
    }

    void addParam(const JsonValue& value) {
        if (value.kind == JsonValue::Kind::kString)
            addText(value.text.starts_with('$') ? "graph parameter" : "choice", &value);
    }
};

/// One letter too many, one too few, a wrong one, or two exchanged.
std::string misspell(std::string word, std::mt19937& random) {
    static constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
    const char letter = kLetters[random() % kLetters.size()];
    const std::size_t at = random() % word.size();
    switch (random() % 4) {
    case 0:
        return word.insert(at, 1, letter);
    case 1:
        return word.erase(at, 1);
    case 2:
        word[at] = letter;
        return word;
    default:
        if (at + 1 < word.size())
            std::swap(word[at], word[at + 1]);
        return word;
    }
}

/// The first word that a hint quotes.
std::string firstQuoted(const std::string& hint) {
    const std::size_t begin = hint.find('"') + 1;
    return begin == 0 ? "" : hint.substr(begin, hint.find('"', begin) - begin);
}

/// How many edits a word suffers, and the least share of right suggestions.
struct Sloppiness {
    int edits;
    double right;
};

class Typos : public testing::TestWithParam<Sloppiness> {};

TEST_P(Typos, AreFoundWhereTheyAreAndWhatWasMeantIsSuggestedFirst) {
    PassRegistry passes;
    registerPasses(passes);
    TraceBackendRegistry tracers;
    registerTraceBackends(tracers);
    const Words words;
    ASSERT_EQ(words.by_kind.size(), 10u);

    struct Score {
        int all = 0, placed = 0, meant = 0;
    };
    std::map<std::string, Score> scores;
    Score total;
    std::mt19937 random(2012);
    for (const auto& [kind, candidates] : words.by_kind)
        for (int round = 0; round < 100; ++round) {
            const Word& word = candidates[random() % candidates.size()];
            std::string typo = word.text;
            for (int edit = 0; edit < GetParam().edits && !typo.empty(); ++edit)
                typo = misspell(typo, random);
            if (typo.empty() || words.spellings.contains(typo) || passes.find(typo) != nullptr)
                continue;
            const Graph& graph = words.graphs[word.graph];
            std::string text = graph.text;
            text.replace(word.at, word.text.size(), typo);
            std::vector<Diagnostic> diagnostics;
            const GraphDesc desc = parseGraph(graph.file, text, diagnostics,
                                              filesBeside(HONE_SOURCE_DIR "/graphs/sir.json"));
            (void)compile(desc, {&passes, &tracers}, {}, diagnostics);

            // The place of a word begins at its quote.
            const auto place = desc.source->locate(static_cast<std::uint32_t>(word.at - 1));
            const auto found = std::ranges::find_if(diagnostics, [&](const Diagnostic& d) {
                return d.line == place.line && d.column == place.column &&
                       d.length == typo.size() + 2;
            });
            const bool is_placed = found != diagnostics.end();
            const bool is_meant = is_placed && firstQuoted(found->hint) == word.text;
            for (Score* score : {&scores[kind], &total}) {
                ++score->all;
                score->placed += is_placed;
                score->meant += is_meant;
            }
            if (!is_meant)
                std::cout << kind << ": \"" << word.text << "\" as \"" << typo << "\"\n"
                          << format(is_placed ? std::vector<Diagnostic>{*found} : diagnostics);
        }

    for (const auto& [kind, score] : scores)
        std::cout << kind << ": " << score.all << " typos, " << score.placed << " places, "
                  << score.meant << " suggestions right\n";
    std::cout << "all: " << total.all << " typos, " << total.placed << " places, " << total.meant
              << " suggestions right\n";
    EXPECT_GE(total.all, 500);
    EXPECT_EQ(total.placed, total.all);
    EXPECT_GE(total.meant, GetParam().right * total.all);
}

INSTANTIATE_TEST_SUITE_P(All, Typos, testing::Values(Sloppiness{1, 0.95}, Sloppiness{2, 0.90}),
                         [](const auto& each) {
                             return each.param.edits == 1 ? "OfOneEdit" : "OfTwoEdits";
                         });

} // namespace
} // namespace hone

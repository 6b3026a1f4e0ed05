// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/diagnostics.h"
#include "hone/core/graph/source_text.h"
#include "hone/core/pass/param.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace hone {

/// The version of the graph format that this program writes; it reads all from 1 on.
inline constexpr int kGraphVersion = 2;

/// A name or reference as it was written.
struct Word {
    std::string text;
    Place place;
};

/// A parameter's value as it was written: a literal, or the name of a graph parameter ("$batch").
struct ParamText {
    Word name;
    std::variant<bool, double, std::string> value;
    Place place; ///< of the value

    [[nodiscard]] bool isReference() const {
        const std::string* text = std::get_if<std::string>(&value);
        return text != nullptr && text->starts_with('$');
    }
};

/// Where a value comes from: "pass.port", "loop.carried", "subgraph.output", "$input", "~carried".
struct EdgeDesc {
    Word from; ///< without "@-1"
    std::vector<ParamText> params;
    bool is_zero = false; ///< {"zero": "Type"}: `from` names the type
    /// "pass.port@-1": what the value was in the last frame; in the first it is this edge.
    bool is_history = false;
    std::unique_ptr<EdgeDesc> initial;
};

struct InputDesc {
    Word port;
    bool is_list = false; ///< written as [ ... ]
    std::vector<EdgeDesc> edges;
};

struct CarryDesc {
    Word name;
    EdgeDesc initial;
};

struct NextDesc {
    Word name;
    Word from;
};

/// {"empty": "request.requests"}, {"iterations": 64}, {"ms": "$max_ms"},
/// {"below": 0.004, "of": "request.worst"}.
struct StopDesc {
    ParamText rule;
    Word of; ///< "below": the Scalar that is compared
};

struct PassDesc;
struct GraphDesc;

/// A loop: its passes run until a stop rule holds; `next` becomes `carry` of the next iteration.
struct LoopDesc {
    std::vector<CarryDesc> carry;
    std::vector<PassDesc> passes;
    std::vector<NextDesc> next;
    std::vector<StopDesc> stop;
    std::uint32_t check_every = 1;
    Place place; ///< of the key "loop"
};

/// When a pass runs at all: "$flag", "!$flag", {"$mode": "radix"}, {"$mode": ["a", "b"]}.
struct WhenDesc {
    Word param; ///< with its "$"
    bool is_negated = false;
    std::vector<Word> choices; ///< empty: a bool parameter
};

/// What readers of an output get while its pass is switched off.
struct BypassDesc {
    Word output;
    EdgeDesc from;
};

/// A pass, a loop (`loop`) or another graph that is used as a pass (`graph`).
struct PassDesc {
    Word name;
    Word type; ///< "" for loops and graphs
    std::vector<InputDesc> inputs;
    std::vector<ParamText> params;
    Word on; ///< "host", "device", "auto"; "" where it was not written
    std::string doc;
    std::optional<LoopDesc> loop;
    Word graph;                       ///< the file's name; "" where it is none
    const GraphDesc* body = nullptr;  ///< that graph; null if it could not be read
    Word shader;                      ///< file of a pass of type "glsl"
    const SourceText* code = nullptr; ///< that file; null if it could not be read
    std::optional<WhenDesc> when;
    std::vector<BypassDesc> bypass;
};

struct GraphParamDesc {
    Word name;
    ParamDecl decl;
    Place default_place;
};

struct GraphInputDesc {
    Word name;
    Word type; ///< "scene", "camera", "extent", or a port type's name in a graph for use in others
};

struct OutputDesc {
    Word name;
    Word from;
    Word type{}; ///< "" where the file leaves it to what feeds it
    std::string doc{};
};

/// What a graph takes from a plug-in, so that its absence can be told in those words.
struct PluginDesc {
    Word name;
    std::vector<Word> passes;
};

/// A graph file as it was written, in its order, with the place of every word. Nothing is resolved
/// yet. Places point into `source`.
struct GraphDesc {
    std::unique_ptr<const SourceText> source;
    std::string name;
    std::string doc;
    int version = kGraphVersion; ///< as it was written
    std::vector<PluginDesc> plugins;
    std::vector<GraphParamDesc> params;
    std::vector<GraphInputDesc> inputs;
    std::vector<PassDesc> passes;
    std::vector<OutputDesc> outputs;
    Place outputs_place;
    bool is_readable =
        false; ///< false: not even JSON, or of another version; compile() adds nothing

    /// The other files that it uses, each once; only of the graph that was asked for.
    std::vector<std::unique_ptr<GraphDesc>> graphs;
    std::vector<std::unique_ptr<const SourceText>> shaders;
};

/// Gives the text of a file that a graph names, by its path relative to that graph's folder
/// ("parts/refine.json", never outside the folder); nothing if it cannot be read.
using ReadFile = std::function<std::optional<std::string>(const std::string& path)>;

/// Files of the folder that `path` lies in, of at most 16 MiB.
[[nodiscard]] ReadFile filesBeside(const std::string& path);

/// Reads a graph from its text, and the files that it names through `files` (empty: it may name
/// none), or else from the folder `shipped` ("" for none), so that a copy of a shipped graph finds
/// its parts wherever it lies. `file` names it in reports. Older versions are upgraded as they are
/// read. Adds problems to `diagnostics` and returns what could be read, so that compile() can
/// report the rest in the same run.
[[nodiscard]] GraphDesc parseGraph(std::string file, std::string text,
                                   std::vector<Diagnostic>& diagnostics, const ReadFile& files = {},
                                   const std::string& shipped = {});
/// The same for a file, whose stem names a graph without a name; a file that cannot be read is the
/// problem E0106.
[[nodiscard]] GraphDesc parseGraphFile(const std::string& path,
                                       std::vector<Diagnostic>& diagnostics,
                                       const std::string& shipped = {});

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/diagnostics.h"
#include "hone/core/graph/source_text.h"
#include "hone/core/pass/param.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace hone {

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

/// Where a value comes from: "pass.port", "loop.carried", "$input", "~carried".
struct EdgeDesc {
    Word from;
    std::vector<ParamText> params;
    bool is_zero = false; ///< a carry's {"zero": "Type"}: `from` names the type
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

/// {"empty": "request.requests"}, {"iterations": 64}, {"ms": "$max_ms"}.
struct StopDesc {
    ParamText rule;
};

struct PassDesc;

/// A loop: its passes run until a stop rule holds; `next` becomes `carry` of the next iteration.
struct LoopDesc {
    std::vector<CarryDesc> carry;
    std::vector<PassDesc> passes;
    std::vector<NextDesc> next;
    std::vector<StopDesc> stop;
    std::uint32_t check_every = 1;
    Place place; ///< of the key "loop"
};

struct PassDesc {
    Word name;
    Word type; ///< "" for a loop
    std::vector<InputDesc> inputs;
    std::vector<ParamText> params;
    Word on; ///< "host", "device", "auto"; "" where it was not written
    std::string doc;
    std::optional<LoopDesc> loop;
};

struct GraphParamDesc {
    Word name;
    ParamDecl decl;
    Place default_place;
};

struct GraphInputDesc {
    Word name;
    Word type; ///< "scene", "camera" or "extent"
};

struct OutputDesc {
    Word name;
    Word from;
};

/// A graph file as it was written, in its order, with the place of every word. Nothing is resolved
/// yet.
struct GraphDesc {
    SourceText source;
    std::string name;
    std::string doc;
    std::vector<GraphParamDesc> params;
    std::vector<GraphInputDesc> inputs;
    std::vector<PassDesc> passes;
    std::vector<OutputDesc> outputs;
    Place outputs_place;
    bool is_readable =
        false; ///< false: not even JSON, or of another version; compile() adds nothing
};

/// Reads a graph from its text; `file` names it in reports. Adds problems to `diagnostics` and
/// returns what could be read, so that compile() can report the rest in the same run.
[[nodiscard]] GraphDesc parseGraph(std::string file, std::string text,
                                   std::vector<Diagnostic>& diagnostics);
/// The same for a file, whose stem names a graph without a name; a file that cannot be read is the
/// problem E0106.
[[nodiscard]] GraphDesc parseGraphFile(const std::string& path,
                                       std::vector<Diagnostic>& diagnostics);

} // namespace hone

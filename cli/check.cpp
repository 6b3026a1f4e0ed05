// SPDX-License-Identifier: Apache-2.0
//
// hone check: every problem in graph files, without opening a device.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include <algorithm>
#include <ostream>

namespace hone::cli {
namespace {

/// line 0: the problem is not in a file, but in an override.
nlohmann::ordered_json toJson(const Diagnostic& diagnostic) {
    nlohmann::ordered_json notes = nlohmann::ordered_json::array();
    for (const Note& note : diagnostic.notes)
        notes.push_back({{"file", note.file},
                         {"line", note.line},
                         {"column", note.column},
                         {"message", note.message}});
    return {{"code", diagnostic.code},
            {"severity", diagnostic.severity == Severity::kError ? "error" : "warning"},
            {"file", diagnostic.file},
            {"line", diagnostic.line},
            {"column", diagnostic.column},
            {"length", diagnostic.length},
            {"pointer", diagnostic.pointer},
            {"message", diagnostic.message},
            {"hint", diagnostic.hint},
            {"notes", notes}};
}

} // namespace

int check(const CheckArguments& arguments, const Console& console) {
    const Session session(arguments.plugins);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    int result = kOk;
    for (const std::string& name : arguments.graphs) {
        const std::string path = findGraph(name);
        std::vector<Diagnostic> diagnostics;
        const Catalog catalog = session.catalog();
        const GraphDesc desc = parseGraphFile(path, diagnostics, catalog.graphs);
        const CompiledGraph graph = compile(desc, catalog, arguments.overrides, diagnostics);
        const auto errors = std::ranges::count_if(
            diagnostics, [](const Diagnostic& d) { return d.severity == Severity::kError; });
        for (const Diagnostic& diagnostic : diagnostics)
            all.push_back(toJson(diagnostic));
        console.err << format(diagnostics);
        if (errors > 0) {
            result = kBadInput;
        } else if (!arguments.json) {
            console.out << path << ": ok\n";
            if (arguments.plan)
                console.out << dump(graph, arguments.size);
        }
    }
    if (arguments.json)
        print(console.out, {{"diagnostics", all}});
    return result;
}

} // namespace hone::cli

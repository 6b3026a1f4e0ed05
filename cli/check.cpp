// SPDX-License-Identifier: Apache-2.0
//
// hone check: every problem in graph files, without opening a device.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include <algorithm>
#include <ostream>

namespace hone::cli {

int check(const CheckArguments& arguments, const Console& console) {
    const Session session(arguments.plugins);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    int result = kOk;
    for (const std::string& name : arguments.graphs) {
        const std::string path = findGraph(name);
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraphFile(path, diagnostics);
        const CompiledGraph graph =
            compile(desc, session.catalog(), arguments.overrides, diagnostics);
        const auto errors = std::ranges::count_if(
            diagnostics, [](const Diagnostic& d) { return d.severity == Severity::kError; });
        for (const Diagnostic& d : diagnostics)
            all.push_back({{"code", d.code},
                           {"severity", d.severity == Severity::kError ? "error" : "warning"},
                           {"file", d.file},
                           {"line", d.line},
                           {"column", d.column},
                           {"pointer", d.pointer},
                           {"message", d.message},
                           {"hint", d.hint}});
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

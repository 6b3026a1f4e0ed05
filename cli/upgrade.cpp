// SPDX-License-Identifier: Apache-2.0
//
// hone upgrade: carries graph files of older versions over to the present one.
#include "hone/cli/commands.h"

#include "hone/core/graph/graph_desc.h"
#include "hone/core/graph/upgrade.h"
#include "hone/core/image/atomic_file.h"
#include "hone/core/printable.h"

#include <ostream>
#include <vector>

namespace hone::cli {
namespace {

/// Says each change with its place in the file as it was.
void printEdits(const SourceText& source, const UpgradedText& upgraded, std::ostream& out) {
    for (const UpgradeEdit& edit : upgraded.edits) {
        const SourceText::Position at = source.locate(edit.span.begin);
        out << printable(source.file()) << ":" << at.line << ":" << at.column << ": "
            << printable(edit.reason) << "\n";
    }
}

} // namespace

int upgrade(const UpgradeArguments& arguments, const Console& console) {
    int result = kOk;
    for (const std::string& path : arguments.graphs) {
        // Read as every graph is: with its limits, and E0106 where it cannot be. What else is wrong
        // in it is for check to say.
        std::vector<Diagnostic> diagnostics;
        const GraphDesc desc = parseGraphFile(path, diagnostics);
        const SourceText& source = *desc.source;
        std::erase_if(diagnostics, [](const Diagnostic& d) { return d.code != "E0106"; });
        if (!diagnostics.empty()) {
            console.err << format(diagnostics);
            result = kBadInput;
            continue;
        }
        const UpgradedText upgraded = upgradeText(source, diagnostics);
        console.err << format(diagnostics);
        if (!upgraded.is_valid) {
            result = kBadInput;
        } else if (arguments.print) {
            console.out << upgraded.text;
        } else if (upgraded.edits.empty()) {
            console.out << printable(path) << ": is of the present version\n";
        } else {
            writeFileAtomically(path, std::as_bytes(std::span(upgraded.text)));
            printEdits(source, upgraded, console.out);
        }
    }
    return result;
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
//
// hone upgrade: carries graph files of older versions over to the present one.
#include "hone/cli/commands.h"

#include "hone/core/error.h"
#include "hone/core/graph/upgrade.h"
#include "hone/core/image/atomic_file.h"
#include "hone/core/printable.h"

#include <fstream>
#include <ostream>
#include <sstream>

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
        std::ostringstream text;
        if (std::ifstream file(path, std::ios::binary); !(text << file.rdbuf())) {
            console.err << printable(path)
                        << ": error E0106: the graph file cannot be read\n"
                           "  = help: does it exist, and may you read it?\n\n";
            result = kBadInput;
            continue;
        }
        const SourceText source(path, text.str());
        std::vector<Diagnostic> diagnostics;
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

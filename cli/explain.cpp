// SPDX-License-Identifier: Apache-2.0
//
// hone explain: what a diagnostic's code means; why a graph's pass or value is as it is.
#include "hone/cli/commands.h"
#include "hone/cli/explain_code.h"
#include "hone/cli/explain_value.h"

#include "hone/core/printable.h"

#include <ostream>

namespace hone::cli {

int explain(const ExplainArguments& arguments, const Console& console) {
    if (arguments.value.empty() && (arguments.target.empty() || looksLikeCode(arguments.target)))
        return explainCode(arguments.target, arguments.json, console);
    if (!arguments.value.empty())
        return explainValue(arguments.target, arguments.value, arguments.overrides,
                            arguments.plugins, console);
    console.err << "\"" << printable(arguments.target)
                << "\" is no diagnostic's code, like E0301; of a graph say what to explain: hone "
                   "explain GRAPH PASS.PORT\n";
    return kUsage;
}

} // namespace hone::cli

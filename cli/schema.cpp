// SPDX-License-Identifier: Apache-2.0
//
// hone schema: the JSON Schema of graph files, for editors and other programs. Plug-ins' passes are
// in it.
#include "hone/cli/commands.h"
#include "hone/cli/graph_schema.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

namespace hone::cli {

int schema(const SessionArguments& arguments, const Console& console) {
    const Session session(arguments.plugins);
    print(console.out, graphSchema(session.catalog()));
    return kOk;
}

} // namespace hone::cli

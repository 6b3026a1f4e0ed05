// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/cli/command_run.h"

#include "hone/cli/commands.h"
#include "hone/cli/session.h"

#include <sstream>

namespace hone::cli {

CommandRun runHone(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"hone"};
    for (const std::string& argument : arguments)
        argv.push_back(argument.c_str());
    std::ostringstream out, err;
    CommandRun run;
    run.code = runCommandLine(static_cast<int>(argv.size()), argv.data(), out, err);
    run.out = out.str();
    run.err = err.str();
    return run;
}

std::string whyNoRaster() {
    static const std::string reason = [] {
        Session session;
        return session.openDevices("", false).raster == nullptr ? session.rasterProblem()
                                                                : std::string();
    }();
    return reason;
}

} // namespace hone::cli

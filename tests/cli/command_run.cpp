// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/cli/command_run.h"

#include "hone/cli/commands.h"
#include "hone/cli/session.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

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

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hone-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        throw std::runtime_error("no temporary folder: " + name);
    folder_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return path(name);
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

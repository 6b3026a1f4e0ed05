// SPDX-License-Identifier: Apache-2.0
//
// hone new-pass: what it writes, and what it refuses. That it builds: support/custom_pass.sh.
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace hone::cli {
namespace {

namespace fs = std::filesystem;

std::string textOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TEST(NewPass, WritesAFolderNamedThroughout) {
    const TemporaryFolder folder;
    const CommandRun run = runHone({"new-pass", "error.my_metric", "-o", folder.path("mine")});
    EXPECT_EQ(run.code, kOk) << run.err;
    EXPECT_NE(run.out.find("cmake -S "), std::string::npos);
    for (const char* name :
         {"CMakeLists.txt", "error_my_metric.cpp", "error_my_metric.json", "README.md"}) {
        const std::string text = textOf(folder.path(std::string("mine/") + name));
        EXPECT_NE(text.find("my_metric"), std::string::npos) << name;
        EXPECT_EQ(text.find('@'), std::string::npos) << name << " was not filled in";
    }
    const std::string source = textOf(folder.path("mine/error_my_metric.cpp"));
    EXPECT_NE(source.find("struct ErrorMyMetric {"), std::string::npos);
    EXPECT_NE(source.find("pass.called(\"error.my_metric\""), std::string::npos);
    EXPECT_NE(source.find("HONE_PASS_PLUGIN(ErrorMyMetric,"), std::string::npos);
    // The graph is whole but for the plug-in.
    const CommandRun check = runHone({"check", folder.path("mine/error_my_metric.json")});
    EXPECT_EQ(check.code, kBadInput);
    EXPECT_NE(check.err.find("plug-in \"error_my_metric\" is not loaded"), std::string::npos)
        << check.err;
    EXPECT_EQ(check.err.find("error E", check.err.find("error E") + 1), std::string::npos)
        << check.err;
}

TEST(NewPass, DoesNotOverwrite) {
    const TemporaryFolder folder;
    const std::string kept = folder.write("kept.txt", "mine");
    const CommandRun run = runHone({"new-pass", "blur", "-o", folder.path()});
    EXPECT_EQ(run.code, kNotWritten);
    EXPECT_NE(run.err.find("not empty"), std::string::npos) << run.err;
    EXPECT_EQ(textOf(kept), "mine");
    EXPECT_FALSE(fs::exists(folder.path("blur.cpp")));
    EXPECT_EQ(runHone({"new-pass", "blur", "-o", kept}).code, kNotWritten) << "a file is no folder";
}

TEST(NewPass, RefusesWhatNoPassCanBeCalled) {
    const TemporaryFolder folder;
    const std::string target = folder.path("mine");
    for (const char* name : {"Blur", "my-blur", "9lives", "", "auto", "a/b", "glsl", "../x"}) {
        const CommandRun run = runHone({"new-pass", name, "-o", target});
        EXPECT_EQ(run.code, kUsage) << name;
        EXPECT_NE(run.err, "") << name;
    }
    const CommandRun run = runHone({"new-pass", "sort", "-o", target});
    EXPECT_EQ(run.code, kUsage);
    EXPECT_NE(run.err.find("a pass called \"sort\" is already there"), std::string::npos)
        << run.err;
    EXPECT_FALSE(fs::exists(target));
}

} // namespace
} // namespace hone::cli

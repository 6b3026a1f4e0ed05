// SPDX-License-Identifier: Apache-2.0
//
// Plug-ins as the command line meets them: --plugin, HONE_PLUGIN_PATH, exit code 4.
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"
#include "hone/tests/support/bad_plugins.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace hone::cli {
namespace {

using test::pluginFile;

/// Sets HONE_PLUGIN_PATH for its scope.
class PluginPath {
public:
    explicit PluginPath(const std::string& value) { setenv("HONE_PLUGIN_PATH", value.c_str(), 1); }
    ~PluginPath() { unsetenv("HONE_PLUGIN_PATH"); }
    PluginPath(const PluginPath&) = delete;
    PluginPath& operator=(const PluginPath&) = delete;
};

CommandRun render(const std::string& backend, const std::string& output,
                  std::vector<std::string> more) {
    std::vector<std::string> arguments{"render",   "prt",  "--scene", "builtin:one_triangle",
                                       "--size",   "8x8",  "--set",   "backend=" + backend,
                                       "--device", "none", "-o",      output,
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runHone(arguments);
}

class RefusedPlugins : public testing::TestWithParam<test::BadPlugin> {};

TEST_P(RefusedPlugins, EndTheCommandWith4AndTheReason) {
    const CommandRun run = runHone({"check", "prt", "--plugin", pluginFile(GetParam().name)});
    EXPECT_EQ(run.code, kPluginFailed);
    EXPECT_NE(run.err.find(GetParam().reason), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
}

INSTANTIATE_TEST_SUITE_P(All, RefusedPlugins, testing::ValuesIn(test::badPlugins()),
                         [](const auto& tested) { return std::string(tested.param.name); });

class RefusedPasses : public testing::TestWithParam<test::BadPlugin> {};

TEST_P(RefusedPasses, EndTheCommandWith4AndTheReason) {
    const test::BadPassCase spoiled(GetParam().name);
    const CommandRun run = runHone({"passes", "--plugin", pluginFile("bad_pass")});
    EXPECT_EQ(run.code, kPluginFailed);
    EXPECT_NE(run.err.find(GetParam().reason), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
}

INSTANTIATE_TEST_SUITE_P(All, RefusedPasses, testing::ValuesIn(test::badPasses()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(PluginOption, EndsEveryCommandThatReadsItWith4) {
    const TemporaryFolder folder;
    const std::vector<std::vector<std::string>> commands = {
        {"check", "prt"},     {"render", "prt", "-o", folder.path("out")},
        {"passes"},           {"new-pass", "mine", "-o", folder.path("mine")},
        {"doctor"},           {"bench", "parts"},
        {"bench", "tracers"}, {"demo", "-o", folder.path("demo")}};
    for (std::vector<std::string> command : commands) {
        command.insert(command.end(), {"--plugin", folder.path("absent.so")});
        const CommandRun run = runHone(command);
        EXPECT_EQ(run.code, kPluginFailed) << command[0];
        EXPECT_NE(run.err.find("absent.so: No such file"), std::string::npos) << run.err;
    }
}

TEST(PluginOption, MayStandBeforeOrAfterTheCommandAndRepeat) {
    const TemporaryFolder folder;
    const std::string graph = folder.write("g.json", R"({ "hone": 1,
  "params": { "backend": { "type": "enum", "from": "trace_backends", "default": "plain_c" } },
  "inputs": { "scene": "scene", "camera": "camera", "extent": "extent" },
  "passes": { "request": { "type": "request" },
              "trace": { "type": "trace", "params": { "backend": "$backend" },
                "in": { "requests": "request.requests", "scene": "$scene", "camera": "$camera" } } },
  "outputs": { "samples": "trace.samples" } })");
    const std::string c = pluginFile("plain_c"), failing = pluginFile("failing");
    EXPECT_EQ(runHone({"check", graph}).code, kBadInput);
    EXPECT_EQ(runHone({"check", graph, "--plugin", c}).code, kOk);
    EXPECT_EQ(runHone({"--plugin", c, "check", graph}).code, kOk);
    EXPECT_EQ(runHone({"check", "--plugin", failing, "--plugin", c, graph}).code, kOk);
    EXPECT_EQ(runHone({"check", "--plugin", failing, graph}).code, kBadInput);
}

TEST(PluginPathVariable, LoadsWhatItsFoldersHaveAndLeavesOutTheRest) {
    const PluginPath path(HONE_TEST_PLUGINS ":relative");
    const CommandRun run = runHone({"passes", "trace"});
    EXPECT_EQ(run.code, kOk);
    EXPECT_NE(run.out.find("plain_c"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("wrong_magic"), std::string::npos);
}

TEST(PluginPathVariable, IsListedByDoctor) {
    const TemporaryFolder folder;
    std::filesystem::copy_file(pluginFile("plain_c"), folder.path("c.so"));
    std::filesystem::copy_file(pluginFile("declines"), folder.path("d.so"));
    const PluginPath path(folder.path());
    const CommandRun run = runHone({"doctor", "--json"});
    const nlohmann::json report = run.json();
    std::vector<nlohmann::json> found, left_out;
    bool is_backend_there = false;
    for (const nlohmann::json& check : report["checks"]) {
        if (check["check"] == "plug-in")
            (check["ok"] ? found : left_out).push_back(check["detail"]);
        if (check["check"] == "trace backend" && check["detail"] == "plain_c 2.1 on host")
            is_backend_there = true;
    }
    ASSERT_EQ(found.size(), 1u) << run.out;
    ASSERT_EQ(left_out.size(), 1u) << run.out;
    EXPECT_EQ(found[0].get<std::string>().find("plain_c 2.1 (Apache-2.0, built by "), 0);
    EXPECT_NE(found[0].get<std::string>().find("Offers trace backend plain_c"), std::string::npos);
    EXPECT_NE(left_out[0].get<std::string>().find("d.so: it declines"), std::string::npos);
    EXPECT_TRUE(is_backend_there) << run.out;
}

TEST(PluginBackendRun, EndsWith4WhereThePluginFails) {
    const TemporaryFolder folder;
    const std::vector<std::string> plugin{"--plugin", pluginFile("failing")};
    for (const char* backend : {"create_fails", "create_throws", "build_throws", "closest_fails",
                                "closest_names_no_primitive"}) {
        const CommandRun run = render(backend, folder.path(backend), plugin);
        EXPECT_EQ(run.code, kPluginFailed) << backend << ": " << run.err;
        EXPECT_NE(run.err.find(std::string("trace backend \"") + backend + "\": "),
                  std::string::npos)
            << run.err;
    }
}

TEST(PluginBackendRun, EndsWith5And6WhereThePluginSaysSo) {
    const TemporaryFolder folder;
    const std::vector<std::string> plugin{"--plugin", pluginFile("failing")};
    EXPECT_EQ(render("create_has_no_device", folder.path("a"), plugin).code, kNoDevice);
    EXPECT_EQ(render("create_has_no_memory", folder.path("b"), plugin).code, kNoMemory);
}

TEST(PluginPasses, AreListedWithTheirPlugin) {
    const std::string plugin = pluginFile("good_passes");
    const CommandRun list = runHone({"passes", "--plugin", plugin});
    EXPECT_NE(list.out.find("Tells what it was told (plug-in good_passes)"), std::string::npos)
        << list.out;
    const nlohmann::json tell =
        runHone({"passes", "test.tell", "--json", "--plugin", plugin}).json();
    EXPECT_EQ(tell["plugin"], "good_passes");
    EXPECT_EQ(tell["outputs"][0]["type"], "Told");
    EXPECT_EQ(runHone({"passes", "sort", "--json"}).json()["plugin"], "");
}

/// A graph whose node "mine" is that pass, which has no inputs.
CommandRun renderPass(const std::string& type, const TemporaryFolder& folder) {
    const std::string graph = folder.write("g.json", R"({ "hone": 1,
  "passes": { "mine": { "type": ")" + type + R"(" } },
  "outputs": { "result": "mine.result" } })");
    return runHone({"render", graph, "--scene", "builtin:one_triangle", "--size", "8x8", "--device",
                    "none", "-o", folder.path("out"), "--quiet", "--plugin",
                    pluginFile("failing_passes")});
}

TEST(PluginPasses, EndTheRunWith4AndNameThePluginAndTheNode) {
    const TemporaryFolder folder;
    for (const char* type : {"execute_fails", "execute_throws", "execute_throws_a_number",
                             "execute_throws_bad_alloc", "writes_nan"}) {
        const CommandRun run = renderPass(type, folder);
        EXPECT_EQ(run.code, kPluginFailed) << type << ": " << run.err;
        EXPECT_EQ(run.err.find("plug-in /"), 0u) << run.err;
        EXPECT_NE(run.err.find(std::string("pass \"mine\" (") + type + "): "), std::string::npos)
            << run.err;
    }
    EXPECT_EQ(renderPass("create_throws", folder).code, kPluginFailed);
    EXPECT_EQ(renderPass("execute_has_no_device", folder).code, kNoDevice);
    EXPECT_EQ(renderPass("execute_has_no_memory", folder).code, kNoMemory);
    EXPECT_EQ(renderPass("keeps_nothing", folder).code, kOk);
}

TEST(PluginPasses, AreThereInGraphsLikeHones) {
    const TemporaryFolder folder;
    const std::string graph = folder.write("g.json", R"({ "hone": 1,
  "passes": { "one": { "type": "test.increase" },
              "two": { "type": "test.increase", "in": { "before": "one.after" } },
              "mix": { "type": "test.mix", "in": { "planes": [
                  { "from": "one.after", "weight": 10 }, { "from": "two.after", "bias": 0.5 } ] } } },
  "outputs": { "sum": "mix.sum" } })");
    const std::string plugin = pluginFile("good_passes");
    EXPECT_EQ(runHone({"check", graph, "--plugin", plugin}).code, kOk);
    const CommandRun run =
        runHone({"render", graph, "--scene", "builtin:one_triangle", "--size", "3x2", "--device",
                 "none", "-o", folder.path("out"), "--quiet", "--plugin", plugin});
    EXPECT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(runHone({"check", graph, "--plugin", plugin, "--set", "mix.wrong=1"}).code,
              kBadInput);
}

} // namespace
} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_search.h"

#include "hone/backends/backends.h"
#include "hone/backends/host/parallel_for.h"
#include "hone/core/error.h"
#include "hone/core/trace/trace_backend.h"
#include "hone/tests/support/bad_plugins.h"
#include "hone/tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace hone::test {
namespace {

namespace fs = std::filesystem;

class PluginSearching : public testing::Test {
protected:
    PluginSearching() { registerTraceBackends(registry_); }

    /// The names of the plug-ins that a search loads.
    std::vector<std::string> load(const PluginSearch& search) {
        plugins_ = loadPlugins(search, passes_, registry_, hostParallelFor, problems_);
        std::vector<std::string> names;
        for (const Plugin& plugin : plugins_)
            names.push_back(plugin.info().name);
        return names;
    }
    /// A copy of a test's plug-in in a folder.
    static void put(const std::string& plugin, const TemporaryFolder& folder,
                    const std::string& name) {
        fs::copy_file(pluginFile(plugin), folder.path(name));
    }

    PassRegistry passes_;
    TraceBackendRegistry registry_;
    std::vector<Plugin> plugins_;
    std::vector<std::string> problems_;
    using Names = std::vector<std::string>;
};

TEST_F(PluginSearching, FindsNothingInNoPlace) {
    EXPECT_EQ(load({}), Names{});
    EXPECT_TRUE(problems_.empty());
}

TEST_F(PluginSearching, LoadsNamedFilesInTheirOrderThenFoldersByName) {
    const TemporaryFolder folder;
    put("newer_minor", folder, "b.so"); // called bad
    put("plain_c", folder, "a.so");
    put("throws", folder, "ignored.txt");
    fs::create_directory(folder.path("below"));
    fs::copy_file(pluginFile("failing"), folder.path("below/c.so"));
    EXPECT_EQ(load({.files = {pluginFile("failing")}, .folders = {folder.path()}}),
              (Names{"failing", "plain_c", "bad"}));
    EXPECT_TRUE(problems_.empty());
    EXPECT_TRUE(registry_.contains("plain_c"));
    EXPECT_TRUE(registry_.contains("closest_fails"));
}

TEST_F(PluginSearching, LoadsAFileOnceHoweverOftenItIsMet) {
    const TemporaryFolder folder;
    put("plain_c", folder, "a.so");
    fs::create_symlink(folder.path("a.so"), folder.path("b.so"));
    EXPECT_EQ(load({.files = {folder.path("a.so"), folder.path("b.so")},
                    .folders = {folder.path(), folder.path()}}),
              Names{"plain_c"});
    EXPECT_TRUE(problems_.empty());
}

TEST_F(PluginSearching, RefusesABadPluginThatWasNamed) {
    EXPECT_THROW(load({.files = {pluginFile("plain_c"), pluginFile("wrong_magic")}}), PluginError);
    EXPECT_THROW(load({.files = {pluginFile("absent")}}), PluginError);
}

TEST_F(PluginSearching, LeavesOutABadPluginThatWasFound) {
    const TemporaryFolder folder;
    put("throws", folder, "a.so");
    put("plain_c", folder, "b.so");
    EXPECT_EQ(load({.folders = {folder.path()}}), Names{"plain_c"});
    ASSERT_EQ(problems_.size(), 1u);
    EXPECT_NE(problems_[0].find("a.so: its entry threw an exception"), std::string::npos)
        << problems_[0];
}

TEST_F(PluginSearching, KeepsTheFirstOfTwoPluginsOfAName) {
    const TemporaryFolder first, second;
    put("plain_c", first, "one.so");
    put("plain_c", second, "two.so");
    EXPECT_EQ(load({.folders = {first.path(), second.path()}}), Names{"plain_c"});
    EXPECT_EQ(plugins_[0].info().file, fs::canonical(first.path("one.so")));
    ASSERT_EQ(problems_.size(), 1u);
    EXPECT_NE(problems_[0].find("it is called \"plain_c\", as is "), std::string::npos)
        << problems_[0];
    PassRegistry no_passes;
    TraceBackendRegistry others;
    EXPECT_THROW((void)loadPlugins({.files = {first.path("one.so"), second.path("two.so")}},
                                   no_passes, others, hostParallelFor, problems_),
                 PluginError);
}

TEST_F(PluginSearching, SaysThatAFolderIsMissingOrOpenToAnybody) {
    const TemporaryFolder folder;
    put("plain_c", folder, "a.so");
    fs::permissions(folder.path(), fs::perms::others_write, fs::perm_options::add);
    EXPECT_EQ(load({.folders = {folder.path(), "/nowhere/at/all"}}), Names{});
    ASSERT_EQ(problems_.size(), 2u);
    EXPECT_NE(problems_[0].find("anybody may write to it"), std::string::npos) << problems_[0];
    EXPECT_NE(problems_[1].find("/nowhere/at/all: no such folder"), std::string::npos);
}

TEST_F(PluginSearching, TakesOnlyAbsolutePathsFromAVariable) {
    const std::vector<fs::path> folders =
        foldersOfVariable("HONE_PLUGIN_PATH", "/a/b::relative:.:/c:", problems_);
    EXPECT_EQ(folders, (std::vector<fs::path>{"/a/b", "/c"}));
    ASSERT_EQ(problems_.size(), 2u);
    EXPECT_EQ(problems_[0], "HONE_PLUGIN_PATH: \"relative\" is left out: only absolute paths are "
                            "searched for plug-ins");
    EXPECT_EQ(foldersOfVariable("HONE_PLUGIN_PATH", "", problems_), std::vector<fs::path>{});
}

} // namespace
} // namespace hone::test

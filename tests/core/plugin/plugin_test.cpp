// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin.h"

#include "hone/backends/backends.h"
#include "hone/backends/host/parallel_for.h"
#include "hone/core/error.h"
#include "hone/passes/passes.h"
#include "hone/tests/support/bad_plugins.h"
#include "hone/tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include <elf.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hone::test {
namespace {

namespace fs = std::filesystem;

/// Why `file` is refused; "" if it is not.
std::string refusal(const fs::path& file) {
    PassRegistry passes;
    registerPasses(passes);
    TraceBackendRegistry registry;
    registerTraceBackends(registry);
    const std::vector<std::string> before = registry.names();
    const std::size_t passes_before = passes.all().size();
    try {
        Plugin(file, hostParallelFor).addTo(passes, registry);
    } catch (const PluginError& problem) {
        EXPECT_EQ(registry.names(), before) << "a refused plug-in left something behind";
        EXPECT_EQ(passes.all().size(), passes_before);
        return problem.what();
    }
    return "";
}

std::string bytesOf(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

class BadPlugins : public testing::TestWithParam<BadPlugin> {};

TEST_P(BadPlugins, AreRefusedWithTheirFileAndReason) {
    const std::string file = pluginFile(GetParam().name);
    const std::string text = refusal(file);
    EXPECT_EQ(text.find("plug-in " + fs::canonical(file).string() + ": "), 0) << text;
    EXPECT_CONTAINS(text, GetParam().reason);
    for (const char c : text)
        EXPECT_GE(static_cast<unsigned char>(c), 32) << "a terminal would obey this";
}

INSTANTIATE_TEST_SUITE_P(All, BadPlugins, testing::ValuesIn(badPlugins()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(Plugin, SaysWhatItIs) {
    const Plugin plugin(pluginFile("plain_c"), hostParallelFor);
    const PluginInfo& info = plugin.info();
    EXPECT_EQ(info.file, fs::canonical(pluginFile("plain_c")));
    EXPECT_EQ(info.name, "plain_c");
    EXPECT_EQ(info.version, "2.1");
    EXPECT_EQ(info.license, "Apache-2.0");
    EXPECT_EQ(info.doc, "A plug-in in plain C.");
    EXPECT_NE(info.build, "");
    EXPECT_EQ(info.abi_minor, 1u);
    ASSERT_EQ(info.trace_backends.size(), 1u);
    EXPECT_EQ(info.trace_backends[0].name, "plain_c");
    EXPECT_EQ(info.trace_backends[0].version, "2.1") << "the plug-in's where it has none";
    EXPECT_EQ(info.trace_backends[0].runs_on, "host");
}

TEST(Plugin, AddsItsBackendsBehindThoseThatAreThere) {
    TraceBackendRegistry registry;
    registerTraceBackends(registry);
    const std::string preferred = registry.preferred();
    PassRegistry passes;
    Plugin(pluginFile("plain_c"), hostParallelFor).addTo(passes, registry);
    EXPECT_EQ(registry.names().back(), "plain_c");
    EXPECT_EQ(registry.preferred(), preferred);
}

TEST(Plugin, WorksWithANewerMinorVersionOfTheBorder) {
    const Plugin plugin(pluginFile("newer_minor"), hostParallelFor);
    EXPECT_EQ(plugin.info().abi_minor, 2u);
    EXPECT_EQ(plugin.info().trace_backends.size(), 1u);
}

TEST(Plugin, WorksWithAnOlderMinorVersionOfTheBorder) {
    const Plugin plugin(pluginFile("older_minor"), hostParallelFor);
    EXPECT_EQ(plugin.info().abi_minor, 0u);
    EXPECT_EQ(plugin.info().trace_backends.size(), 1u);
    EXPECT_TRUE(plugin.info().passes.empty());
}

class BadPasses : public testing::TestWithParam<BadPlugin> {};

TEST_P(BadPasses, AreRefusedWithTheirFileAndReason) {
    const BadPassCase spoiled(GetParam().name);
    const std::string text = refusal(pluginFile("bad_pass"));
    EXPECT_EQ(text.find("plug-in /"), 0) << text;
    EXPECT_CONTAINS(text, GetParam().reason);
    for (const char c : text)
        EXPECT_GE(static_cast<unsigned char>(c), 32) << "a terminal would obey this";
}

INSTANTIATE_TEST_SUITE_P(All, BadPasses, testing::ValuesIn(badPasses()),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Else the cases above might fail for another reason than theirs.
TEST(Plugin, WorksWhereNothingIsWrongWithItsPass) {
    EXPECT_EQ(refusal(pluginFile("bad_pass")), "");
}

TEST(Plugin, IsNamedInTheReasonEvenWhereItsPathIsHostile) {
    const std::string text = refusal("/nowhere/\x1b[2J.so");
    EXPECT_CONTAINS(text, "plug-in /nowhere/?[2J.so: No such file");
}

TEST(Plugin, IsRefusedWhereThereIsNoFile) {
    EXPECT_CONTAINS(refusal(pluginFile("absent")), "No such file or directory");
    EXPECT_NE(refusal(""), "");
}

TEST(Plugin, IsRefusedWhereItIsAFolder) {
    EXPECT_CONTAINS(refusal(HONE_TEST_PLUGINS), "it is a folder");
}

TEST(Plugin, IsRefusedWhereItIsAPipe) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.path("pipe.so").c_str(), 0600), 0);
    EXPECT_CONTAINS(refusal(folder.path("pipe.so")), "it is not a regular file");
}

TEST(Plugin, IsRefusedWhereItCannotBeRead) {
    if (geteuid() == 0)
        GTEST_SKIP() << "root may read everything";
    const TemporaryFolder folder;
    const std::string file = folder.write("secret.so", bytesOf(pluginFile("plain_c")));
    fs::permissions(file, fs::perms::none);
    EXPECT_CONTAINS(refusal(file), "it cannot be read: Permission denied");
}

TEST(Plugin, IsRefusedWhereAnybodyMayWriteToIt) {
    const TemporaryFolder folder;
    const std::string file = folder.write("open.so", bytesOf(pluginFile("plain_c")));
    EXPECT_EQ(refusal(file), "");
    fs::permissions(file, fs::perms::others_write, fs::perm_options::add);
    EXPECT_CONTAINS(refusal(file), "anybody may write to it:");
}

TEST(Plugin, IsRefusedWhereAnybodyMayWriteToItsFolder) {
    const TemporaryFolder folder;
    const std::string file = folder.write("moved.so", bytesOf(pluginFile("plain_c")));
    fs::permissions(folder.path(), fs::perms::others_write, fs::perm_options::add);
    EXPECT_CONTAINS(refusal(file), "anybody may write to its folder");
    // A link elsewhere does not hide where the file is.
    const TemporaryFolder safe;
    fs::create_symlink(file, safe.path("link.so"));
    EXPECT_CONTAINS(refusal(safe.path("link.so")), "anybody may write to its folder");
}

TEST(Plugin, IsRefusedWhereItIsNoLibrary) {
    const TemporaryFolder folder;
    for (const std::string& content : {std::string(), std::string("\x7f"),
                                       std::string("\x7f"
                                                   "ELG"),
                                       std::string("#!/bin/sh\nexit 0\n"), std::string(4096, '\0')})
        EXPECT_CONTAINS(refusal(folder.write("text.so", content)), "not a shared library");
}

TEST(Plugin, IsRefusedWhereItIsAnotherKindOfElfFile) {
    const TemporaryFolder folder;
    const std::string good = bytesOf(pluginFile("plain_c"));
    const auto with = [&](std::size_t at, std::uint16_t value) {
        std::string changed = good;
        changed[at] = static_cast<char>(value & 0xff);
        changed[at + 1] = static_cast<char>(value >> 8);
        return refusal(folder.write("changed.so", changed));
    };
    EXPECT_CONTAINS(with(offsetof(Elf64_Ehdr, e_type), ET_REL), "not a shared library");
    EXPECT_CONTAINS(with(offsetof(Elf64_Ehdr, e_machine), EM_S390), "another architecture");
    EXPECT_CONTAINS(with(offsetof(Elf64_Ehdr, e_phentsize), 7), "not a shared library");
    std::string changed = good;
    changed[EI_CLASS] = ELFCLASS32;
    EXPECT_CONTAINS(refusal(folder.write("changed.so", changed)), "another architecture");
}

// Without a look at the headers, dlopen maps what is not there and the program dies of SIGBUS.
TEST(Plugin, IsRefusedWhereItIsTruncated) {
    const TemporaryFolder folder;
    const std::string good = bytesOf(pluginFile("plain_c"));
    Elf64_Ehdr header{};
    std::memcpy(&header, good.data(), sizeof header);
    std::uint64_t needed = 0; // bytes that are mapped; behind them are only sections
    for (unsigned i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment{};
        std::memcpy(&segment, good.data() + header.e_phoff + i * sizeof segment, sizeof segment);
        needed = std::max(needed, segment.p_offset + segment.p_filesz);
    }
    ASSERT_LE(needed, good.size());
    for (const std::uint64_t bytes :
         {std::uint64_t{4}, std::uint64_t{63}, std::uint64_t{64}, std::uint64_t{100},
          std::uint64_t{4096}, needed / 2, needed - 1})
        EXPECT_CONTAINS(refusal(folder.write("short.so", good.substr(0, bytes))), "truncated")
            << " at " << bytes;
}

} // namespace
} // namespace hone::test

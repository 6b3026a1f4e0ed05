// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin.h"

#include "hone/core/error.h"
#include "hone/core/plugin/elf_file.h"
#include "hone/core/plugin/plugin_backend.h"
#include "hone/core/plugin/plugin_pass.h"
#include "hone/core/plugin/plugin_pass_tables.h"
#include "hone/core/plugin/plugin_tables.h"
#include "hone/core/printable.h"

#include <dlfcn.h>

namespace hone {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBackends = 256;

bool anybodyMayWrite(const fs::path& path) {
    return (fs::status(path).permissions() & fs::perms::others_write) != fs::perms::none;
}

void checkFile(const fs::path& file) {
    if (fs::is_directory(file))
        throw Refusal("it is a folder; name the file in it");
    if (!fs::is_regular_file(file)) // a pipe would never end
        throw Refusal("it is not a regular file");
    if (anybodyMayWrite(file))
        throw Refusal("anybody may write to it: chmod o-w makes it safe to load");
    if (anybodyMayWrite(file.parent_path()))
        throw Refusal("anybody may write to its folder: chmod o-w makes it safe to load from");
    if (const std::string why = whyNotLoadable(file); !why.empty())
        throw Refusal(why);
}

std::string abi(std::uint32_t major, std::uint32_t minor) {
    return std::to_string(major) + "." + std::to_string(minor);
}

/// Calls the entry and checks the part of what it returns that is the same in all versions.
const hone_plugin& shakeHands(hone_plugin_entry_function entry) {
    const hone_plugin* plugin = nullptr;
    try {
        plugin = entry(HONE_PLUGIN_ABI_MAJOR, HONE_PLUGIN_ABI_MINOR);
    } catch (const std::exception& problem) {
        throw Refusal(std::string("its entry threw an exception: ") + printable(problem.what()));
    } catch (...) {
        throw Refusal("its entry threw something that is no std::exception");
    }
    const std::string ours = abi(HONE_PLUGIN_ABI_MAJOR, HONE_PLUGIN_ABI_MINOR);
    if (plugin == nullptr)
        throw Refusal("it declines to work with this hone (plug-in ABI " + ours + ")");
    if (plugin->magic != HONE_PLUGIN_MAGIC)
        throw Refusal("its table has the wrong magic number: it is no plug-in of hone");
    if (plugin->abi_major != HONE_PLUGIN_ABI_MAJOR)
        throw Refusal("it speaks plug-in ABI " + abi(plugin->abi_major, plugin->abi_minor) +
                      ", this hone " + ours + ": " +
                      (plugin->abi_major > HONE_PLUGIN_ABI_MAJOR
                           ? "it needs a newer hone"
                           : "build it anew with this hone's headers"));
    return *plugin;
}

void readBackend(const hone_trace_backend& offered, std::size_t index, PluginLibrary& library) {
    std::string what = "trace backend " + std::to_string(index);
    const hone_trace_backend table =
        copyTable(offered, sizeof(hone_trace_backend), "the table of its " + what);
    PluginInfo::Backend info;
    info.name = nameOf(table.name, "the name of its " + what);
    what = "its trace backend \"" + info.name + "\"";
    info.doc = textOf(table.doc, what + ": doc");
    info.version =
        table.version != nullptr ? textOf(table.version, what + ": version") : library.info.version;
    info.runs_on = table.runs_on != nullptr ? textOf(table.runs_on, what + ": runs_on") : "host";
    require(table.create, what + ": create");
    require(table.destroy, what + ": destroy");
    require(table.build, what + ": build");
    require(table.closest, what + ": closest");
    require(table.occluded, what + ": occluded");
    constexpr std::uint32_t kKnownFlags = HONE_TRACE_ALWAYS_EXACT | HONE_TRACE_SETTLES_TIES |
                                          HONE_TRACE_UPDATES | HONE_TRACE_REFERENCE |
                                          HONE_TRACE_NO_MASKS;
    checkFlags(table.flags, kKnownFlags, library.info.abi_minor, what);
    for (const PluginInfo::Backend& other : library.info.trace_backends)
        if (other.name == info.name)
            throw Refusal("it offers two trace backends called \"" + info.name + "\"");
    library.info.trace_backends.push_back(std::move(info));
    library.trace_backends.push_back(table);
}

/// Copies and checks everything that the tables say.
void readTables(const hone_plugin& offered, PluginLibrary& library) {
    const hone_plugin table = copyTable(offered, offsetof(hone_plugin, port_types), "its table");
    PluginInfo& info = library.info;
    info.name = nameOf(table.name, "its name");
    info.version = textOf(table.version, "its version");
    info.license = textOf(table.license, "its license");
    info.doc = textOf(table.doc, "its doc");
    info.build = textOf(table.build, "its build");
    info.abi_minor = table.abi_minor;
    if (table.abi_minor == 0 && table.pass_count > 0)
        throw Refusal("it offers passes, which plug-in ABI " + abi(HONE_PLUGIN_ABI_MAJOR, 0) +
                      " does not have");
    if (table.trace_backend_count == 0 && table.pass_count == 0)
        throw Refusal("it offers neither a trace backend nor a pass");
    readList(table.trace_backends, table.trace_backend_count, kMostBackends,
             "its list of trace backends", "its trace backend",
             [&](const hone_trace_backend& backend, std::size_t i) {
                 readBackend(backend, i, library);
             });
    readPasses(table, library);
}

std::shared_ptr<const PluginLibrary> load(const fs::path& file, ParallelFor parallel_for) {
    checkFile(file);
    auto library = std::make_shared<PluginLibrary>();
    library->info.file = file.string();
    library->parallel_for = parallel_for;
    library->handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library->handle == nullptr)
        throw Refusal(std::string("it cannot be loaded: ") + printable(dlerror()));
    void* entry = dlsym(library->handle, HONE_PLUGIN_ENTRY);
    if (entry == nullptr)
        throw Refusal("it exports no " HONE_PLUGIN_ENTRY ": it is no plug-in of hone");
    readTables(shakeHands(reinterpret_cast<hone_plugin_entry_function>(entry)), *library);
    return library;
}

} // namespace

PluginLibrary::~PluginLibrary() {
    if (handle != nullptr)
        dlclose(handle);
}

Plugin::Plugin(const fs::path& file, ParallelFor parallel_for) {
    const std::string which = "plug-in " + printable(file.string()) + ": ";
    try {
        library_ = load(fs::canonical(file), parallel_for);
    } catch (const Refusal& refusal) {
        throw PluginError(which + refusal.what());
    } catch (const fs::filesystem_error& problem) {
        throw PluginError(which + problem.code().message());
    }
}

void Plugin::addTo(PassRegistry& passes, TraceBackendRegistry& backends) const {
    const std::string who = "plug-in " + printable(info().file) + ": its ";
    for (const PluginInfo::Backend& backend : info().trace_backends)
        if (backends.contains(backend.name))
            throw PluginError(who + "trace backend \"" + backend.name +
                              "\" has the name of another that is already there");
    for (const std::string& name : info().passes)
        if (const PassType* other = passes.find(name))
            throw PluginError(who + "pass \"" + name + "\" has the name of one of " +
                              (other->plugin.empty() ? "hone's" : "plug-in " + other->plugin));
    for (const PortType& known : graphTypes(passes))
        for (const PluginPortType& brought : library_->port_types)
            if (brought.type == known &&
                (brought.type.shape != known.shape || brought.type.stride != known.stride ||
                 brought.type.format != known.format))
                throw PluginError(who + "port type \"" + brought.name +
                                  "\" has the name of another whose elements lie otherwise");

    for (std::size_t i = 0; i < info().trace_backends.size(); ++i)
        backends.add(
            info().trace_backends[i].name, info().trace_backends[i].doc,
            [library = library_, i](const Devices&) { return makePluginBackend(library, i); });
    for (std::size_t i = 0; i < info().passes.size(); ++i)
        passes.add(makePluginPassType(library_, i));
}

} // namespace hone

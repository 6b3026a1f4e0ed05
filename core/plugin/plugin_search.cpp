// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_search.h"

#include "hone/core/error.h"
#include "hone/core/printable.h"

#include <algorithm>

namespace hone {
namespace {

namespace fs = std::filesystem;

/// The libraries of a folder, by name. Throws PluginError that names the folder.
std::vector<fs::path> librariesIn(const fs::path& folder) {
    const auto refuse = [&](const std::string& why) {
        throw PluginError("plug-in folder " + printable(folder.string()) + ": " + why);
    };
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (!fs::is_directory(status))
        refuse("no such folder");
    if ((status.permissions() & fs::perms::others_write) != fs::perms::none)
        refuse("anybody may write to it: chmod o-w makes it safe to load from");
    std::vector<fs::path> found;
    fs::directory_iterator entries(folder, error);
    if (error)
        refuse(error.message());
    for (const fs::directory_entry& entry : entries)
        if (entry.path().extension() == ".so")
            found.push_back(entry.path());
    std::ranges::sort(found);
    return found;
}

class Loading {
public:
    Loading(PassRegistry& passes, TraceBackendRegistry& backends, ParallelFor parallel_for)
        : passes_(passes), backends_(backends), parallel_for_(parallel_for) {}

    /// Throws PluginError.
    void add(const fs::path& file) {
        std::error_code error;
        const std::string real = fs::canonical(file, error).string();
        const auto has_file = [&](const Plugin& it) { return it.info().file == real; };
        if (!error && std::ranges::any_of(plugins, has_file))
            return;
        Plugin plugin(file, parallel_for_);
        const PluginInfo& info = plugin.info();
        const auto has_name = [&](const Plugin& it) { return it.info().name == info.name; };
        if (const auto other = std::ranges::find_if(plugins, has_name); other != plugins.end())
            throw PluginError("plug-in " + printable(info.file) + ": it is called \"" + info.name +
                              "\", as is " + printable(other->info().file));
        plugin.addTo(passes_, backends_);
        plugins.push_back(std::move(plugin));
    }

    std::vector<Plugin> plugins;

private:
    PassRegistry& passes_;
    TraceBackendRegistry& backends_;
    ParallelFor parallel_for_;
};

} // namespace

std::vector<fs::path> foldersOfVariable(std::string_view name, std::string_view value,
                                        std::vector<std::string>& problems) {
    std::vector<fs::path> folders;
    while (!value.empty()) {
        const std::size_t end = std::min(value.find(':'), value.size());
        const fs::path folder(value.substr(0, end));
        value.remove_prefix(std::min(end + 1, value.size()));
        if (folder.is_absolute())
            folders.push_back(folder);
        else if (!folder.empty())
            problems.push_back(std::string(name) + ": \"" + printable(folder.string()) +
                               "\" is left out: only absolute paths are searched for plug-ins");
    }
    return folders;
}

std::vector<Plugin> loadPlugins(const PluginSearch& search, PassRegistry& passes,
                                TraceBackendRegistry& backends, ParallelFor parallel_for,
                                std::vector<std::string>& problems) {
    Loading loading(passes, backends, parallel_for);
    for (const fs::path& file : search.files)
        loading.add(file);
    for (const fs::path& folder : search.folders) {
        std::vector<fs::path> files;
        try {
            files = librariesIn(folder);
        } catch (const PluginError& problem) {
            problems.emplace_back(problem.what());
        }
        for (const fs::path& file : files) {
            try {
                loading.add(file);
            } catch (const PluginError& problem) {
                problems.emplace_back(problem.what());
            }
        }
    }
    return std::move(loading.plugins);
}

} // namespace hone

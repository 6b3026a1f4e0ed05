// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/plugin/plugin_library.h"

#include <filesystem>
#include <memory>

namespace hone {

class PassRegistry;
class TraceBackendRegistry;

/// A loaded plug-in (hone_plugin.h says what that is). Its code stays while this, a registry that
/// it was added to, or a backend that was made by it lives.
class Plugin {
public:
    /// Opens `file` and shakes hands with it; runs its code. Throws PluginError: no such file, one
    /// that anybody may write to (or its folder), not a shared library of this machine, no
    /// hone_plugin_entry, another ABI, tables that are short, incomplete or ill-named, an entry
    /// that declines or throws.
    Plugin(const std::filesystem::path& file, ParallelFor parallel_for);

    [[nodiscard]] const PluginInfo& info() const { return library_->info; }

    /// Adds its passes and trace backends. Throws PluginError, and adds none, if a name is taken,
    /// or a port type has the name of another that is laid out otherwise.
    void addTo(PassRegistry& passes, TraceBackendRegistry& backends) const;

private:
    std::shared_ptr<const PluginLibrary> library_;
};

} // namespace hone

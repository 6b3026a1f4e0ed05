// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/plugin/hone_plugin.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hone {

/// What a plug-in says of itself. Texts have no control bytes.
struct PluginInfo {
    std::string file; ///< absolute, links resolved
    std::string name, version, license, doc;
    std::string build; ///< how it was built
    std::uint32_t abi_minor = 0;
    struct Backend {
        std::string name, doc, version, runs_on;
    };
    std::vector<Backend> trace_backends;
};

/// The threads that plug-ins may use: calls body(context, begin, end) for ranges of at most `grain`
/// that cover [0, count). What hone_host::parallel_for does.
using ParallelFor = void (*)(std::size_t count, std::size_t grain,
                             void (*body)(void* context, std::size_t begin, std::size_t end),
                             void* context);

/// A plug-in's code and its checked tables. Shared by all who may still call it: the last one to go
/// unloads it.
struct PluginLibrary {
    PluginLibrary() = default;
    PluginLibrary(const PluginLibrary&) = delete;
    PluginLibrary& operator=(const PluginLibrary&) = delete;
    ~PluginLibrary();

    void* handle = nullptr;
    PluginInfo info;
    std::vector<hone_trace_backend> trace_backends; ///< as info's; missing members are 0
    ParallelFor parallel_for = nullptr;
};

} // namespace hone

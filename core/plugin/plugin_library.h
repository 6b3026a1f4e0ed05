// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/parallel_for.h"
#include "hone/core/pass/pass_type.h"
#include "hone/core/plugin/hone_pass.h"
#include "hone/core/plugin/hone_plugin.h"

#include <cstddef>
#include <cstdint>
#include <deque>
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
    std::vector<std::string> passes; ///< their types' names
};

/// A type of ports that a plug-in brings: the texts that its PortType points to.
struct PluginPortType {
    std::string name, doc, format, unit;
    PortType type;
};

/// What is believed of one pass type.
inline constexpr std::size_t kMostPluginPorts = 32; ///< inputs, outputs
inline constexpr std::size_t kMostPluginParams = 64;

/// A pass type as a plug-in's tables declare it.
struct PluginPassType {
    PassType type;          ///< without create and size rules, which keep the library (addTo)
    hone_pass_type table{}; ///< its functions count
    std::vector<std::size_t (*)(const hone_size_query*)> sizes; ///< by output; may be null
    std::vector<std::string> counters;
};

/// A plug-in's code and its checked tables. Shared by all who may still call it or read its texts:
/// the last one to go unloads it.
struct PluginLibrary {
    PluginLibrary() = default;
    PluginLibrary(const PluginLibrary&) = delete;
    PluginLibrary& operator=(const PluginLibrary&) = delete;
    ~PluginLibrary();

    void* handle = nullptr;
    PluginInfo info;
    std::vector<hone_trace_backend> trace_backends; ///< as info's; missing members are 0
    std::deque<PluginPortType> port_types;          ///< their places stay
    std::vector<PluginPassType> passes;             ///< as info's
    ParallelFor parallel_for = nullptr;
};

} // namespace hone

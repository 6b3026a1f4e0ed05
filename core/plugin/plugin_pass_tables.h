// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/plugin/plugin_library.h"

namespace hone {

/// Copies and checks the port types and passes of a plug-in's table into `library`, whose info is
/// there. Throws Refusal (plugin_tables.h): tables that are short or incomplete, names that are
/// none or there twice, types that nobody knows or whose elements have another size, defaults
/// outside their range. Not looked at: what other plug-ins offer.
void readPasses(const hone_plugin& plugin, PluginLibrary& library);

// Its parts. `owner` begins what a Refusal says: "its pass \"blur\"".

void readPortTypes(const hone_plugin& plugin, PluginLibrary& library);
[[nodiscard]] std::vector<ParamDecl> readParams(const hone_param* const* params, std::size_t count,
                                                const PluginLibrary& library,
                                                const std::string& owner);
/// A port type that hone has by itself; null if that is none.
[[nodiscard]] const PortType* findOwnType(std::string_view name);

} // namespace hone

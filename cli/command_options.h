// SPDX-License-Identifier: Apache-2.0
//
// Options that several commands take. Each stores what it reads in an argument that must outlive
// the parsing.
#pragma once

#include "hone/cli/commands.h"

#include <CLI/App.hpp>

namespace hone::cli {

/// "800x600".
CLI::Option* addSize(CLI::App* app, const std::string& name, uvec2& size, const std::string& doc);
/// --sizes: several of them, instead of those that are there.
void addSizes(CLI::App* app, std::vector<uvec2>& sizes);
/// --set NAME=VALUE
void addOverrides(CLI::App* app, Overrides& overrides);
/// --pin PASS.PORT[@ITERATION]=FILE
void addPins(CLI::App* app, std::vector<PinRequest>& pins);
/// What measure, fit and bench figure10 have in common.
void addMeasureOptions(CLI::App* app, MeasureArguments& arguments);

} // namespace hone::cli

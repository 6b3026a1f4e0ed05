// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace hone {

using ParamLiteral = std::variant<bool, double, std::string>;

/// Why a parameter cannot have a value.
struct ParamProblem {
    const char* code = "";
    std::string message;
    std::string hint;
};

/// The names that an enum parameter may take.
[[nodiscard]] std::vector<std::string> choicesOf(const ParamDecl& decl, const Catalog& catalog);

/// The literal as a value of the declared type and range, or why not. `whose` names the parameter
/// in the message: `parameter "batch" of pass "request"`.
[[nodiscard]] std::variant<ParamValue, ParamProblem> readParam(const ParamDecl& decl,
                                                               const ParamLiteral& literal,
                                                               const Catalog& catalog,
                                                               const std::string& whose);

/// A graph parameter's value for one that it feeds; a uint may feed a float.
[[nodiscard]] std::variant<ParamValue, ParamProblem> convertParam(const PlannedParam& from,
                                                                  const ParamDecl& to,
                                                                  const Catalog& catalog,
                                                                  const std::string& whose);

/// Sets "param" of the graph or "pass.param" from text, with all that it feeds; on a problem
/// nothing changes. Adds the nodes (passes and loops) whose behaviour it changes to `changed`.
[[nodiscard]] std::optional<ParamProblem> assignParam(CompiledGraph& graph, const Catalog& catalog,
                                                      const std::string& path,
                                                      const std::string& text,
                                                      std::vector<NodeId>& changed);

/// Has the loop a rule that ends it whatever its passes do?
[[nodiscard]] bool isBounded(const PlannedLoop& loop);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

#include <nlohmann/json.hpp>

namespace hone::cli {

/// What names and references look like, as regular expressions of ECMA 262.
namespace pattern {
inline const std::string kName = "[A-Za-z0-9_-]+";
inline const std::string kSource =
    "(\\$" + kName + "|~" + kName + "|" + kName + "(\\." + kName + ")+)";
} // namespace pattern

/// { "$ref": "#/definitions/NAME" }
[[nodiscard]] nlohmann::ordered_json refTo(const std::string& definition);
/// A string that is all of `expression`.
[[nodiscard]] nlohmann::ordered_json textLike(const std::string& expression);
/// A parameter's value as a graph writes it: a literal in range, or "$name".
[[nodiscard]] nlohmann::ordered_json paramSchema(const ParamDecl& decl, const Catalog& catalog);
/// An edge into a port, with the parameters that it may have.
[[nodiscard]] nlohmann::ordered_json edgeSchema(const std::vector<ParamDecl>& params,
                                                const Catalog& catalog);
/// What "in", "params" and "on" may be in a pass of this type.
[[nodiscard]] nlohmann::ordered_json passSchema(const PassType& type, const Catalog& catalog);

} // namespace hone::cli

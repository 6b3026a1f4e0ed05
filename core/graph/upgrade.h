// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/json_source.h"

#include <string>
#include <vector>

namespace hone {

/// One change that carries a graph over to the present format.
struct UpgradeEdit {
    TextSpan span; ///< what it replaces
    std::string replacement;
    Place place;
    std::string reason; ///< "pass type \"difference\" is \"measure.error\" since version 2"
};

/// Changes a graph of an older version, `version`, into one of kGraphVersion. The edits do to the
/// text what was done to the tree; comments and layout stay.
[[nodiscard]] std::vector<UpgradeEdit> upgradeTree(JsonValue& root, int version,
                                                   const SourceText& source);

/// A graph file of the present version: the text, and what was changed in it.
struct UpgradedText {
    std::string text;
    std::vector<UpgradeEdit> edits; ///< places are those of the old text
    bool is_valid = false;          ///< false: diagnostics say why it cannot be upgraded
};

/// What `hone upgrade` writes. A graph of the present version comes back as it was.
[[nodiscard]] UpgradedText upgradeText(const SourceText& source,
                                       std::vector<Diagnostic>& diagnostics);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/json.h"
#include "hone/core/trace/check/check_backend.h"

#include <string>

namespace hone::cli {

/// {"differing", "ties", "silhouettes", "unexplained"}.
[[nodiscard]] nlohmann::ordered_json toJson(const DifferenceCounts& counts);
/// {"closest": {"lists", "rays", "judged", ...}, "occluded": {...}, "spoiled_rays"}.
[[nodiscard]] nlohmann::ordered_json toJson(const CheckReport& report);
/// A line a kind of query, for a person.
[[nodiscard]] std::string toText(const CheckReport& report);

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <nlohmann/json.hpp>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace hone::cli {

/// How a part compares with its bare counterpart, and what it is held to.
struct BenchRatio {
    std::string path; ///< in the JSON's ratios of a size: "trace_vs_embree/primary"
    double value = 0;
    double target = 0;
    bool at_least = false; ///< else: at most

    [[nodiscard]] bool isMet() const { return at_least ? value >= target : value <= target; }
};

struct BenchPart {
    std::string name;
    uvec2 size{0, 0};
    double ms = 0;   ///< median
    double rate = 0; ///< in unit; 0 = none
    std::string unit;
    std::optional<BenchRatio> ratio;
};

/// What a bench measured, for people and for programs.
struct BenchTable {
    std::vector<BenchPart> parts;

    /// {"parts": [...], "ratios": {"800x600": {"trace_vs_embree": {"primary": {"value", "target",
    /// "better", "ok"}}}}}
    [[nodiscard]] nlohmann::ordered_json json() const;
    void print(std::ostream& out) const;
    [[nodiscard]] bool allMet() const;
};

} // namespace hone::cli

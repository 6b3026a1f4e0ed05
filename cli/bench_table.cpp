// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_table.h"

#include <algorithm>
#include <cstdio>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string text(uvec2 size) {
    return std::to_string(size.x) + "x" + std::to_string(size.y);
}

} // namespace

Json BenchTable::json() const {
    Json list = Json::array();
    Json ratios = Json::object();
    for (const BenchPart& part : parts) {
        list.push_back({{"name", part.name},
                        {"size", text(part.size)},
                        {"ms", part.ms},
                        {"rate", part.rate},
                        {"unit", part.unit}});
        if (part.ratio)
            ratios[Json::json_pointer("/" + text(part.size) + "/" + part.ratio->path)] = {
                {"value", part.ratio->value},
                {"target", part.ratio->target},
                {"better", part.ratio->at_least ? "higher" : "lower"},
                {"ok", part.ratio->isMet()}};
    }
    return {{"parts", list}, {"ratios", ratios}};
}

void BenchTable::print(std::ostream& out) const {
    const auto line = [&out](const char* pattern, auto... values) {
        char buffer[256];
        std::snprintf(buffer, sizeof buffer, pattern, values...);
        out << buffer;
    };
    line("%-30s %-10s %10s %20s %9s %10s\n", "name", "size", "ms", "rate", "ratio", "target");
    for (const BenchPart& part : parts) {
        line("%-30s %-10s %10.3f", part.name.c_str(), text(part.size).c_str(), part.ms);
        if (part.rate > 0)
            line(" %10.2f %-9s", part.rate, part.unit.c_str());
        else
            line(" %20s", "");
        if (part.ratio)
            line(" %9.3f %s %8.3f  %s", part.ratio->value,
                 part.ratio->at_least ? ">=" : "<=", part.ratio->target,
                 part.ratio->isMet() ? "ok" : "missed");
        out << "\n";
    }
}

bool BenchTable::allMet() const {
    return std::ranges::all_of(
        parts, [](const BenchPart& part) { return !part.ratio || part.ratio->isMet(); });
}

} // namespace hone::cli

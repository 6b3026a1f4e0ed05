// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/check_report.h"

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

Json kindToJson(const CheckCounts& counts) {
    Json json{{"lists", counts.lists}, {"rays", counts.rays}, {"judged", counts.judged}};
    json.update(toJson(static_cast<const DifferenceCounts&>(counts)));
    return json;
}

std::string kindToText(const char* kind, const CheckCounts& counts) {
    return std::string("checked ") + kind + ": " + std::to_string(counts.rays) + " rays, " +
           std::to_string(counts.judged) + " held against the geometry, " +
           std::to_string(counts.differing) + " differ (" + std::to_string(counts.ties) +
           " ties, " + std::to_string(counts.silhouettes) + " silhouettes, " +
           std::to_string(counts.unexplained) + " unexplained)\n";
}

} // namespace

Json toJson(const DifferenceCounts& counts) {
    return {{"differing", counts.differing},
            {"ties", counts.ties},
            {"silhouettes", counts.silhouettes},
            {"unexplained", counts.unexplained}};
}

Json toJson(const CheckReport& report) {
    return {{"closest", kindToJson(report.closest)},
            {"occluded", kindToJson(report.occluded)},
            {"spoiled_rays", report.spoiled_rays}};
}

std::string toText(const CheckReport& report) {
    std::string text =
        kindToText("closest", report.closest) + kindToText("occluded", report.occluded);
    if (report.spoiled_rays > 0)
        text += "checked: " + std::to_string(report.spoiled_rays) + " rays were not finite\n";
    return text;
}

} // namespace hone::cli

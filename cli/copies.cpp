// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/copies.h"

#include <nlohmann/json.hpp>

#include <ostream>

namespace hone::cli {

nlohmann::ordered_json copiesAsJson(std::span<const MemoryCopy> copies) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MemoryCopy& copy : copies)
        list.push_back(
            {{"what", copy.what}, {"bytes", copy.bytes}, {"why", copy.why}, {"cure", copy.cure}});
    return list;
}

bool areCopiesAllowed(std::span<const MemoryCopy> copies, long long most, std::ostream& err) {
    if (most < 0 || copies.size() <= static_cast<std::size_t>(most))
        return true;
    err << copies.size() << (copies.size() == 1 ? " copy" : " copies")
        << " between memories; --max-copies allows " << most << ":\n";
    for (const MemoryCopy& copy : copies)
        err << "  " << copy.what << ", " << copy.bytes << " bytes: " << copy.why
            << "\n    what would avoid it: " << copy.cure << "\n";
    return false;
}

} // namespace hone::cli

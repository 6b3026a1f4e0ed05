// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>

namespace hone::cli {

/// Prints one JSON object. Text from files may be no UTF-8: what is not is replaced.
inline void print(std::ostream& out, const nlohmann::ordered_json& object) {
    out << object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"

namespace hone::detail {

void assertionFailed(const char* condition, const char* file, int line, const std::string& values) {
    throw std::logic_error(std::string(file) + ":" + std::to_string(line) +
                           ": assertion failed: " + condition + " (" + values + ")");
}

} // namespace hone::detail

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/pass/port_type.h"

#include "hone/core/pass/param.h"

#include <cmath>

namespace hone {

std::string describe(const PortType& type) {
    std::string layout(type.format);
    const auto append = [&](const std::string& part) {
        layout += layout.empty() || part.empty() ? part : ", " + part;
    };
    const auto number = [](float value) { return toString(ParamValue(value)); };
    append(std::string(type.unit));
    if (std::isfinite(type.min) && std::isfinite(type.max))
        append("from " + number(type.min) + " to " + number(type.max));
    else if (std::isfinite(type.min))
        append("at least " + number(type.min));
    else if (std::isfinite(type.max))
        append("at most " + number(type.max));
    return std::string(type.name) + (layout.empty() ? "" : " (" + layout + ")") + ": " +
           std::string(type.doc);
}

} // namespace hone

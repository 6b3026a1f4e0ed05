// SPDX-License-Identifier: Apache-2.0
#include "hone/core/pass/param.h"

#include <charconv>

namespace hone {

const char* name(ParamType type) {
    switch (type) {
    case ParamType::kBool:
        return "bool";
    case ParamType::kUint:
        return "uint";
    case ParamType::kFloat:
        return "float";
    case ParamType::kEnum:
        return "enum";
    }
    return "?";
}

std::string toString(const ParamValue& value) {
    if (const bool* flag = std::get_if<bool>(&value))
        return *flag ? "true" : "false";
    if (const uint* number = std::get_if<uint>(&value))
        return std::to_string(*number);
    if (const std::string* text = std::get_if<std::string>(&value))
        return *text;
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, std::get<float>(value));
    return {buffer, end};
}

} // namespace hone

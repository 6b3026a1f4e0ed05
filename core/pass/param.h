// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace hone {

/// A parameter's value. An enum is its choice's name.
using ParamValue = std::variant<bool, uint, float, std::string>;

enum class ParamType : std::uint8_t { kBool, kUint, kFloat, kEnum };

[[nodiscard]] const char* name(ParamType type);
[[nodiscard]] std::string toString(const ParamValue& value);

/// A parameter as a pass or a graph declares it; the one source of validation, schema, help and
/// binding.
struct ParamDecl {
    std::string name;
    std::string doc;    ///< what it does; special values ("0 = no limit")
    std::string unit{}; ///< "m", "px", "ms"; "" = none, or told in `doc`
    ParamType type = ParamType::kFloat;
    ParamValue fallback = 0.0f; ///< the default
    std::optional<double> min;  ///< numbers: inclusive
    std::optional<double> max;
    std::vector<std::string> choices; ///< enum
    bool from_trace_backends = false; ///< enum whose choices are "auto" and the registered backends
    /// Where the value goes in the kernel's Params (bool and enum as uint, enum by index); npos =
    /// not a kernel's.
    std::size_t kernel_offset = npos;

    static constexpr std::size_t npos = static_cast<std::size_t>(-1);
};

} // namespace hone

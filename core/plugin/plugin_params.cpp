// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_pass_tables.h"

#include "hone/core/plugin/plugin_tables.h"

#include <cmath>
#include <limits>

namespace hone {
namespace {

constexpr std::size_t kMostChoices = 64;

static_assert(HONE_PARAM_BOOL == static_cast<std::uint32_t>(ParamType::kBool) &&
              HONE_PARAM_UINT == static_cast<std::uint32_t>(ParamType::kUint) &&
              HONE_PARAM_FLOAT == static_cast<std::uint32_t>(ParamType::kFloat) &&
              HONE_PARAM_ENUM == static_cast<std::uint32_t>(ParamType::kEnum));

void readChoices(const hone_param& table, ParamDecl& decl, const std::string& what) {
    if (table.choice_count == 0 || table.choice_count > kMostChoices)
        throw Refusal(what + ": an enum has 1 to " + std::to_string(kMostChoices) +
                      " choices, not " + std::to_string(table.choice_count));
    require(table.choices, what + ": choices");
    for (std::uint32_t i = 0; i < table.choice_count; ++i) {
        std::string choice = textOf(table.choices[i], what + ": choice " + std::to_string(i));
        const auto is_allowed = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                   c == '_' || c == '.' || c == '-';
        };
        if (choice.size() > 64 || !std::ranges::all_of(choice, is_allowed))
            throw Refusal(what + ": choice " + inQuotes(choice) +
                          " is none: use letters, digits, _, . and -, at most 64 bytes");
        if (std::ranges::find(decl.choices, choice) != decl.choices.end())
            throw Refusal(what + " has two choices called " + inQuotes(choice));
        decl.choices.push_back(std::move(choice));
    }
}

/// A number that a parameter can have, as the default is given.
ParamValue valueOf(const hone_param& table, const ParamDecl& decl, const std::string& what) {
    const double value = table.fallback;
    const auto refuse = [&](const std::string& expected) {
        throw Refusal(what + ": its default " + std::to_string(value) + " is not " + expected);
    };
    double greatest = 1;
    if (decl.type == ParamType::kEnum)
        greatest = static_cast<double>(decl.choices.size() - 1);
    else if (decl.type == ParamType::kUint)
        greatest = std::numeric_limits<uint>::max();
    else if (decl.type == ParamType::kFloat)
        greatest = std::numeric_limits<float>::max();
    if (decl.type == ParamType::kFloat && !(std::abs(value) <= greatest))
        refuse("a finite float");
    if (decl.type != ParamType::kFloat &&
        !(value >= 0 && value <= greatest && value == std::floor(value)))
        refuse(decl.type == ParamType::kBool   ? "0 or 1"
               : decl.type == ParamType::kUint ? "a whole number of 32 bits"
                                               : "the number of a choice");
    // As floats: 0.3f is greater than 0.3.
    const auto rounded = [&](double number) {
        return decl.type == ParamType::kFloat ? static_cast<float>(number) : number;
    };
    if ((decl.min && rounded(value) < rounded(*decl.min)) ||
        (decl.max && rounded(value) > rounded(*decl.max)))
        refuse("in its range");
    switch (decl.type) {
    case ParamType::kBool:
        return value == 1;
    case ParamType::kUint:
        return static_cast<uint>(value);
    case ParamType::kEnum:
        return decl.choices[static_cast<std::size_t>(value)];
    case ParamType::kFloat:
        break;
    }
    return static_cast<float>(value);
}

ParamDecl readParam(const hone_param& offered, std::size_t index, const PluginLibrary& library,
                    const std::string& owner) {
    std::string what = "parameter " + std::to_string(index);
    const hone_param table =
        copyTable(offered, sizeof(hone_param), owner + ": the table of its " + what);
    ParamDecl decl;
    decl.name = memberNameOf(table.name, owner + ": the name of its " + what);
    what = owner + ": parameter " + inQuotes(decl.name);
    decl.doc = textOf(table.doc, what + ": doc");
    decl.unit = optionalTextOf(table.unit, what + ": unit");
    if (table.type > HONE_PARAM_ENUM)
        throw Refusal(what + ": type " + std::to_string(table.type) +
                      " is none; use HONE_PARAM_BOOL, _UINT, _FLOAT or _ENUM");
    decl.type = static_cast<ParamType>(table.type);
    checkFlags(table.flags, HONE_HAS_MIN | HONE_HAS_MAX, library.info.abi_minor, what);
    if (decl.type == ParamType::kUint || decl.type == ParamType::kFloat) {
        const TableRange range = rangeOf(table.flags, table.min, table.max, what);
        decl.min = range.min;
        decl.max = range.max;
    } else if ((table.flags & (HONE_HAS_MIN | HONE_HAS_MAX)) != 0) {
        throw Refusal(what + ": only numbers have min and max");
    }
    if (decl.type == ParamType::kEnum)
        readChoices(table, decl, what);
    else if (table.choice_count != 0)
        throw Refusal(what + ": only an enum has choices");
    decl.fallback = valueOf(table, decl, what);
    return decl;
}

} // namespace

std::vector<ParamDecl> readParams(const hone_param* const* params, std::size_t count,
                                  const PluginLibrary& library, const std::string& owner) {
    std::vector<ParamDecl> decls;
    readList(params, count, kMostPluginParams, owner + ": its list of parameters",
             owner + ": its parameter", [&](const hone_param& param, std::size_t i) {
                 ParamDecl decl = readParam(param, i, library, owner);
                 checkIsNew(decls, decl.name, owner, "parameters");
                 decls.push_back(std::move(decl));
             });
    return decls;
}

} // namespace hone

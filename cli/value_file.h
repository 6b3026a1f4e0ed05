// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/image/image.h"
#include "hone/core/pass/value.h"

#include <string>

namespace hone::cli {

/// A plane as a layer of an image: a channel for each number of an element. Whole numbers become
/// floats; above 2^24 they lose their last digits.
[[nodiscard]] ImageLayer toLayer(const std::string& name, const Value& value);

/// A list's or record's valid elements, one a line, under a line that names their numbers; a
/// curve's records.
[[nodiscard]] std::string toCsv(const Value& value);

} // namespace hone::cli

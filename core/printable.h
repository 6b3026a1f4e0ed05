// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace hone {

/// Text that is not trusted (of a file, of a plug-in) as it may be shown to a person: control bytes
/// become '?', and it is cut after 256 bytes.
[[nodiscard]] std::string printable(std::string_view text);

} // namespace hone

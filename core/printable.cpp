// SPDX-License-Identifier: Apache-2.0
#include "hone/core/printable.h"

namespace hone {

std::string printable(std::string_view text) {
    std::string shown(text.substr(0, 256));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < 32 || c == 127)
            c = '?';
    return shown;
}

} // namespace hone

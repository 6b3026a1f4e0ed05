// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/decode.h"

#include "hone/core/error.h"
#include "hone/core/image/jpeg.h"
#include "hone/core/image/png.h"

namespace hone {

Image8 decodeImage(std::span<const std::byte> file, const std::string& name) {
    if (isPng(file))
        return decodePng(file, name);
    if (isJpeg(file))
        return decodeJpeg(file, name);
    throw InputError(name + ": is neither PNG nor JPEG; convert it to one of them");
}

} // namespace hone

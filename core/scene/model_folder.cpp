// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/model_folder.h"

#include "hone/core/error.h"
#include "hone/core/image/image.h"
#include "hone/core/printable.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace hone {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 31;

std::optional<int> hexDigit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return std::nullopt;
}

/// RFC 3986, section 2.1. A '%' without two digits stands for itself, as many exporters mean it.
std::string decodePercent(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size()) {
            const auto high = hexDigit(text[i + 1]);
            const auto low = hexDigit(text[i + 2]);
            if (high && low) {
                decoded += static_cast<char>(16 * *high + *low);
                i += 2;
                continue;
            }
        }
        decoded += text[i];
    }
    return decoded;
}

/// RFC 4648, section 4; padding may be missing.
std::vector<std::byte> decodeBase64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> values;
    values.fill(-1);
    for (std::size_t i = 0; i < kDigits.size(); ++i)
        values[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);

    while (text.ends_with('='))
        text.remove_suffix(1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char digit : text) {
        const int value = values[static_cast<unsigned char>(digit)];
        if (value < 0)
            throw InputError("its base64 has the invalid character '" +
                             printable(std::string(1, digit)) + "'");
        bits = (bits << 6) | static_cast<std::uint32_t>(value);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>((bits >> count) & 255u));
        }
    }
    return bytes;
}

std::vector<std::byte> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos)
        throw InputError("a data: URI without a comma");
    const std::string_view content = uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64"))
        return decodeBase64(content);
    const std::string decoded = decodePercent(content);
    const auto* first = reinterpret_cast<const std::byte*>(decoded.data());
    return {first, first + decoded.size()};
}

/// RFC 3986, section 3.1: a letter, then letters, digits, '+', '-', '.', then ':'. A Windows drive
/// looks the same and is refused with it.
bool hasScheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0 ||
        std::isalpha(static_cast<unsigned char>(uri[0])) == 0)
        return false;
    return std::ranges::all_of(uri.substr(0, colon), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
    });
}

bool isInside(const fs::path& folder, const fs::path& file) {
    const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end() && rest != file.end();
}

} // namespace

ModelFolder::ModelFolder(const fs::path& model) {
    std::error_code error;
    folder_ = fs::canonical(fs::absolute(model).parent_path(), error);
    if (error)
        throw InputError("its folder: " + error.message());
}

std::vector<std::byte> ModelFolder::read(std::string_view uri) const {
    if (uri.starts_with("data:"))
        return decodeDataUri(uri);
    if (hasScheme(uri))
        throw InputError("only relative paths and data: URIs are opened");
    const std::string relative = decodePercent(uri);
    if (relative.empty() || std::ranges::any_of(relative, [](char c) { return c == '\0'; }))
        throw InputError("not a path");
    if (fs::path(relative).is_absolute())
        throw InputError("an absolute path; a model may only name files of its own folder");
    std::error_code error;
    const fs::path file = fs::weakly_canonical(folder_ / relative, error);
    if (error)
        throw InputError(error.message());
    if (!isInside(folder_, file))
        throw InputError("leads outside the model's folder; a model may only name files of its own "
                         "folder");
    // A pipe or a device would never end.
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status))
        throw InputError("no such file");
    if (!fs::is_regular_file(status))
        throw InputError("not a regular file");
    if (fs::file_size(file, error) > kMaxFileBytes)
        throw InputError("larger than 2 GiB");
    return readFile(file.string());
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// The folder of a model: the only place that the URIs in it may read from.
class ModelFolder {
public:
    /// The folder that the file `model` is in. Throws InputError if there is none.
    explicit ModelFolder(const std::filesystem::path& model);

    /// What a URI of the model names: a data: URI's own bytes (base64 or percent-encoded) or a
    /// regular file of at most 2 GiB at or below the folder. Throws InputError with the reason
    /// alone: any other scheme, an absolute path, a path that leads outside once links are
    /// resolved, a file that is missing or cannot be read.
    [[nodiscard]] std::vector<std::byte> read(std::string_view uri) const;

private:
    std::filesystem::path folder_;
};

} // namespace hone

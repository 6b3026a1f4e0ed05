// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace hone {

/// Writes a file so that whoever opens `path`, at any time and after any crash, finds the old bytes
/// or the new ones, never a part: the bytes go to a temporary file in the same directory, which is
/// flushed to the disk and then renamed. A symbolic link at `path` is replaced, not followed.
/// Throws OutputError with the path and the system's reason; the temporary file is gone then.
void writeFileAtomically(const std::string& path, std::span<const std::byte> bytes);

/// Makes sure, before hours of rendering, that results can be written to the directory `path`:
/// creates it and its parents if absent and creates and removes a file in it. Throws OutputError.
void requireWritableDirectory(const std::string& path);

} // namespace hone

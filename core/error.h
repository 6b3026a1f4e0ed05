// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace hone {

/// A bad graph file, parameter or override. The text is a complete report for a person
/// (file:line:column, what, hint), possibly of several problems. Exit code 3.
struct GraphError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A scene or model that cannot be read. Text: file, place in it, what is wrong, what to do. Exit
/// code 3.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A plug-in that cannot be used, or that failed at its work. Text: which one, what is wrong with
/// it, what to do. Exit code 4.
struct PluginError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// No usable device, a failed device call (with the call's text and the result's name), a lost
/// device. Exit code 5.
struct DeviceError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The device or the host has no memory for what was asked. Exit code 6.
struct OutOfMemory : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file that could not be written; nothing is left half-written at its path. Exit code 7.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file that is there but could not be read as what it should be (an image to compare, say). Exit
/// code 3.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A check (check_backend.h) found that a trace backend breaks a promise, or that two disagree
/// where rounding does not explain it. Names the ray and the answers. Exit code 1.
struct CheckFailed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

namespace detail {
[[noreturn]] void assertionFailed(const char* condition, const char* file, int line,
                                  const std::string& values);
}

} // namespace hone

/// A programmer's mistake: throws std::logic_error with the condition, place and values. Always on.
#define HONE_ASSERT(condition, values)                                                             \
    do {                                                                                           \
        if (!(condition)) [[unlikely]]                                                             \
            ::hone::detail::assertionFailed(#condition, __FILE__, __LINE__, (values));             \
    } while (false)

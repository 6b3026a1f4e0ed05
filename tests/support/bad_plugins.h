// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace hone::test {

/// A plug-in that hone must refuse, and what it must say.
struct BadPlugin {
    const char* name;   ///< of the case in tests/plugins/bad_plugin.cpp
    const char* reason; ///< part of the report
};

/// Every case that refuses to load.
[[nodiscard]] std::span<const BadPlugin> badPlugins();

/// The same of the plug-in "bad_pass", whose case a BadPassCase says while it is loaded.
[[nodiscard]] std::span<const BadPlugin> badPasses();

/// What is wrong with the plug-in "bad_pass", for its scope; "" = nothing.
class BadPassCase {
public:
    explicit BadPassCase(const std::string& name);
    ~BadPassCase();
    BadPassCase(const BadPassCase&) = delete;
    BadPassCase& operator=(const BadPassCase&) = delete;
};

/// The file of a plug-in that tests/plugins builds.
[[nodiscard]] inline std::string pluginFile(const std::string& name) {
    return std::string(HONE_TEST_PLUGINS) + "/" + name + ".so";
}

} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
//
// hone new-pass: a folder to begin a plug-in's pass from. It builds as it is.
#include "hone/cli/commands.h"
#include "hone/cli/session.h"

#include "hone/core/error.h"
#include "hone/core/image/atomic_file.h"
#include "hone/core/plugin/plugin_tables.h"
#include "hone/core/printable.h"

#include <cctype>
#include <filesystem>
#include <ostream>

namespace hone::cli {
namespace {

namespace fs = std::filesystem;

// In these, @name@ is "error.blur", @stem@ "error_blur", @Class@ "ErrorBlur", @version@ "0.1".

constexpr const char* kBuild = R"(cmake_minimum_required(VERSION 3.25)
project(@stem@ LANGUAGES CXX)

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
endif()
find_package(hone @version@ REQUIRED)

add_library(@stem@_plugin MODULE @stem@.cpp) # lib@stem@_plugin.so
target_link_libraries(@stem@_plugin PRIVATE hone::plugin)
)";

constexpr const char* kSource =
    R"(// Pass @name@: says how wrong pixels may be. README.md says how to build and use it; what a pass
// may do stands in hone_pass.hpp.
#include <hone_pass.hpp>

#include <algorithm>
#include <cmath>

namespace {

namespace hp = hone::plugin;

struct @Class@ {
    // Ports and parameters: filled in before execute().
    hp::In<hp::Rgb> color;
    hp::Out<hp::Error> error;
    float scale = 1;

    static void declare(hp::Declare<@Class@>& pass) {
        pass.called("@name@", "Flags pixels that differ in luminance from the next ones");
        pass.in(&@Class@::color, "color", "Radiance", "the raster image");
        pass.out(&@Class@::error, "error", "Error", "the difference, scaled; at most 1");
        pass.param(&@Class@::scale, "scale", "what differences are multiplied by", {.min = 0});
    }

    void execute(const hp::Run& run) {
        run.forEachPixel([this](int x, int y) {
            const float here = hp::luminance(color(x, y));
            const float right = hp::luminance(color.clamped(x + 1, y));
            const float below = hp::luminance(color.clamped(x, y + 1));
            const float contrast = std::abs(here - right) + std::abs(here - below);
            // What orders the pixel, and what it is surely not worse than.
            error(x, y) = {std::min(scale * contrast, 1.0f), 1};
        });
    }
};

} // namespace

HONE_PASS_PLUGIN(@Class@, {.name = "@stem@",
                           .version = "0.1",
                           .license = "MIT",
                           .doc = "Offers pass @name@."})
)";

constexpr const char* kGraph = R"({
  "hone": 2,
  "name": "@stem@",
  "doc": "What pass @name@ says of the raster image.",
  "plugins": { "@stem@": ["@name@"] },
  "params": {
    "scale": { "type": "float", "default": 1, "min": 0, "doc": "what differences are multiplied by" },
    "visibility": { "type": "enum", "choices": ["raster", "rays"], "default": "raster", "doc": "rays: works without a Vulkan device" }
  },
  "inputs": { "scene": "scene", "camera": "camera", "extent": "extent" },
  "passes": {
    "raster": {
      "type": "raster",
      "in": { "scene": "$scene", "camera": "$camera" },
      "params": { "visibility": "$visibility" }
    },
    "metric": {
      "type": "@name@",
      "in": { "color": "raster.color" },
      "params": { "scale": "$scale" }
    }
  },
  "outputs": { "color": "raster.color", "error": "metric.error" }
}
)";

constexpr const char* kReadme = R"(# @name@

A pass for hone, as a plug-in.

```sh
cmake -S . -B build -DCMAKE_PREFIX_PATH=/where/hone/is/installed
cmake --build build
hone passes @name@ --plugin build/lib@stem@_plugin.so
hone render @stem@.json --plugin build/lib@stem@_plugin.so -o out
```

- `@stem@.cpp` is the pass: a struct with its ports, its parameters and `execute()`.
- `@stem@.json` is a graph that uses it.
- A folder named in `HONE_PLUGIN_PATH` saves the `--plugin`.
)";

std::string filled(std::string text, const std::string& key, const std::string& value) {
    for (std::size_t at = 0; (at = text.find(key, at)) != std::string::npos; at += value.size())
        text.replace(at, key.size(), value);
    return text;
}

/// "error_blur" as "ErrorBlur".
std::string className(const std::string& stem) {
    std::string result;
    bool begins_word = true;
    for (const char c : stem) {
        if (c != '_')
            result +=
                begins_word ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        begins_word = c == '_';
    }
    return result;
}

/// Why no pass can be called that; "" if one can.
std::string objection(const std::string& name, const PassRegistry& passes) {
    try {
        (void)nameOf(name.c_str(), "the name");
    } catch (const Refusal& refusal) {
        return refusal.what();
    }
    if (name == "glsl")
        return "the name \"glsl\" is hone's, for shader files";
    if (const PassType* taken = passes.find(name))
        return "a pass called \"" + name + "\" is already there" +
               (taken->plugin.empty() ? "" : ", of plug-in " + taken->plugin);
    return "";
}

} // namespace

int newPass(const NewPassArguments& arguments, const Console& console) {
    const Session session(arguments.plugins);
    if (const std::string why = objection(arguments.name, session.passes()); !why.empty()) {
        console.err << why << "\n";
        return kUsage;
    }
    const std::string stem = filled(arguments.name, ".", "_");
    const fs::path folder =
        arguments.output_directory.empty() ? fs::path(stem) : fs::path(arguments.output_directory);
    const std::string shown = printable(folder.string());
    std::error_code error;
    if (fs::exists(folder, error) &&
        !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
        throw OutputError(shown + ": it is there and not empty; name a new folder with -o");
    fs::create_directories(folder, error);
    if (error)
        throw OutputError(shown + ": " + error.message());

    const std::string version(HONE_VERSION);
    const std::string minor_version = version.substr(0, version.find('.', version.find('.') + 1));
    const auto write = [&](const std::string& file, const char* pattern) {
        std::string text = filled(pattern, "@name@", arguments.name);
        text = filled(text, "@stem@", stem);
        text = filled(text, "@Class@", className(stem));
        text = filled(text, "@version@", minor_version);
        writeFileAtomically((folder / file).string(), std::as_bytes(std::span(text)));
    };
    write("CMakeLists.txt", kBuild);
    write(stem + ".cpp", kSource);
    write(stem + ".json", kGraph);
    write("README.md", kReadme);
    console.out << "wrote " << shown << ": CMakeLists.txt, " << stem << ".cpp, " << stem
                << ".json, README.md\n"
                << "next:  cmake -S " << shown << " -B " << shown
                << "/build -DCMAKE_PREFIX_PATH=/where/hone/is/installed\n"
                << "       cmake --build " << shown << "/build\n"
                << "       hone render " << shown << "/" << stem << ".json --plugin " << shown
                << "/build/lib" << stem << "_plugin.so -o out\n";
    return kOk;
}

} // namespace hone::cli

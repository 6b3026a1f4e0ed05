// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/command_options.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <map>
#include <stdexcept>

namespace hone::cli {
namespace {

/// Reads "800x600".
uvec2 toSize(const std::string& option, const std::string& text) {
    uvec2 size{0, 0};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%ux%u%c", &size.x, &size.y, &rest) != 2 || size.x == 0 ||
        size.y == 0 || size.x > 16384 || size.y > 16384)
        throw CLI::ValidationError(
            option, "expected WxH from 1x1 to 16384x16384, like 800x600; got \"" + text + "\"");
    return size;
}

} // namespace

CLI::Option* addSize(CLI::App* app, const std::string& name, uvec2& size, const std::string& doc) {
    return app
        ->add_option_function<std::string>(
            name, [&size, name](const std::string& text) { size = toSize(name, text); }, doc)
        ->type_name("WxH");
}

void addSizes(CLI::App* app, std::vector<uvec2>& sizes) {
    app->add_option_function<std::vector<std::string>>(
           "--sizes",
           [&sizes](const std::vector<std::string>& texts) {
               sizes.clear();
               for (const std::string& text : texts)
                   sizes.push_back(toSize("--sizes", text));
           },
           "image sizes (800x600 1024x768 1920x1080)")
        ->type_name("WxH");
}

void addOverrides(CLI::App* app, Overrides& overrides) {
    app->add_option_function<std::vector<std::string>>(
           "--set",
           [&overrides](const std::vector<std::string>& assignments) {
               for (const std::string& assignment : assignments) {
                   const std::size_t equals = assignment.find('=');
                   if (equals == std::string::npos || equals == 0)
                       throw CLI::ValidationError("--set", "expected name=value; got \"" +
                                                               assignment + "\"");
                   overrides.emplace_back(assignment.substr(0, equals),
                                          assignment.substr(equals + 1));
               }
           },
           "a graph's parameter (batch=4096) or a pass's (refine.trace.max_depth=1); repeatable")
        ->type_name("NAME=VALUE")
        ->take_all();
}

void addPins(CLI::App* app, std::vector<PinRequest>& pins) {
    app->add_option_function<std::vector<std::string>>(
           "--pin",
           [&pins](const std::vector<std::string>& texts) {
               for (const std::string& text : texts)
                   try {
                       pins.push_back(parsePin(text));
                   } catch (const std::invalid_argument& problem) {
                       throw CLI::ValidationError("--pin", problem.what());
                   }
           },
           "save what a pass made, in one iteration of its loop or the last: planes as .exr, "
           "lists as .csv; repeatable")
        ->type_name("PASS.PORT[@ITERATION]=FILE")
        ->take_all();
}

void addMeasureOptions(CLI::App* app, MeasureArguments& arguments) {
    app->add_option("--scene", arguments.scene, "*.scene.json, .gltf, .glb or builtin:NAME")
        ->capture_default_str();
    addSize(app, "--size", arguments.size, "size of each view (400x300)");
    app->add_option("--views", arguments.views,
                    "how many: the scene's cameras, then those turned and moved")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    addOverrides(app, arguments.overrides);
    app->add_option("--truth", arguments.truth, "the graph whose output color is the truth")
        ->capture_default_str();
    app->add_option("--truth-samples", arguments.truth_samples,
                    "samples of the truth (as the graph's); also measures its noise")
        ->check(CLI::PositiveNumber);
    app->add_option(
           "--effect", arguments.effect,
           "what raster image and truth may differ by: all, reflection, shadow, dof, or none "
           "(all)")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, MeasuredEffect>{{"all", MeasuredEffect::kAll},
                                                  {"reflection", MeasuredEffect::kReflection},
                                                  {"shadow", MeasuredEffect::kShadow},
                                                  {"dof", MeasuredEffect::kDof},
                                                  {"none", MeasuredEffect::kNone}}));
    app->add_option("--device", arguments.device, "Vulkan device: part of its name, or its index");
    app->add_option("--seed", arguments.seed, "random numbers' seed (0)");
    app->add_flag("--json", arguments.json, "one JSON object on standard output");
}

} // namespace hone::cli

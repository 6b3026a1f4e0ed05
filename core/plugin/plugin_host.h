// SPDX-License-Identifier: Apache-2.0
//
// hone's side of the border while a plug-in works: what it is given, and how it is called.
#pragma once

#include "hone/core/error.h"
#include "hone/core/plugin/plugin_library.h"
#include "hone/core/printable.h"
#include "hone/core/scene/host_surface.h"
#include "hone/core/trace/ray.glsl.h"

#include <exception>
#include <string>

namespace hone {

/// What hone_scene::hone points to.
struct SceneAccess {
    explicit SceneAccess(const Scene& the_scene) : scene(&the_scene), surface(the_scene) {}
    const Scene* scene;
    HostSurface surface;
};

/// The scene's own arrays, seen through the border's types (same_records.h). Both must outlive it.
[[nodiscard]] hone_scene makeScene(const Scene& scene, const SceneAccess& access);

/// Whether a plug-in's answer is a triangle of the scene, or nothing.
[[nodiscard]] bool isInScene(const Scene& scene, Hit hit);

/// What the border's create() gets; `library` must outlive it.
[[nodiscard]] hone_host makeHost(const PluginLibrary& library);

/// Throws what a status says that is not HONE_OK: DeviceError, OutOfMemory, else PluginError.
[[noreturn]] void throwStatus(const std::string& who, const char* name, hone_status status,
                              hone_error& error);

/// Calls a function of a plug-in, `function(hone_error*)`, and turns what it ends with into an
/// exception: that of throwStatus, or PluginError where an exception crossed the border. who() and
/// `name` begin the text: "plug-in /x.so: pass \"blur\"", "execute".
template <class Who, class Function>
void callPlugin(const Who& who, const char* name, const Function& function) {
    hone_error error{};
    hone_status status = HONE_OK;
    try {
        status = function(&error);
    } catch (const std::exception& problem) {
        throw PluginError(who() + ": " + name +
                          " threw an exception: " + printable(problem.what()));
    } catch (...) {
        throw PluginError(who() + ": " + name + " threw something that is no std::exception");
    }
    if (status != HONE_OK)
        throwStatus(who(), name, status, error);
}

} // namespace hone

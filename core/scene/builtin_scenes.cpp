// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/builtin_scenes.h"

#include "hone/core/error.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace hone {
namespace {

struct Builtin {
    std::string_view name;
    Scene (*make)();
};

constexpr Builtin kBuiltins[] = {
    {"atrium", atriumScene},
    {"cornell", cornellScene},
    {"mirror_sphere", mirrorSphereScene},
    {"planar_mirror", planarMirrorScene},
    {"straight_edge", straightEdgeScene},
    {"lit_floor", litFloorScene},
    {"empty", emptyScene},
    {"one_triangle", oneTriangleScene},
    {"alpha_quad", alphaQuadScene},
    {"two_sided", twoSidedScene},
};

constexpr auto kNames = [] {
    std::array<std::string_view, std::size(kBuiltins)> names;
    std::transform(std::begin(kBuiltins), std::end(kBuiltins), names.begin(),
                   [](const Builtin& builtin) { return builtin.name; });
    return names;
}();

} // namespace

std::span<const std::string_view> builtinScenes() {
    return kNames;
}

Scene makeBuiltinScene(std::string_view name) {
    for (const Builtin& builtin : kBuiltins)
        if (builtin.name == name) {
            Scene scene = builtin.make();
            scene.name = "builtin:" + std::string(name);
            finishScene(scene);
            return scene;
        }
    std::string names;
    for (const std::string_view known : kNames)
        names += (names.empty() ? "" : ", ") + std::string(known);
    throw SceneError("builtin:" + std::string(name) + ": there is no such scene; there are " +
                     names);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/host_surface.h"

#include "hone/core/scene/scene_arrays.h"

namespace hone {

Arguments HostSurface::bind(const Scene& scene) {
    Arguments arguments;
    forEachSceneArray(scene, [&]<class T>(std::string_view name, std::span<const T> elements) {
        // Arguments are made for kernels that write too; this one only reads.
        auto* data = reinterpret_cast<std::byte*>(const_cast<T*>(elements.data()));
        arguments.bind(name, {.bytes = elements.size_bytes(), .data = data});
    });
    return arguments;
}

} // namespace hone

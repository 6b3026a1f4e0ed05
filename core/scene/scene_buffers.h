// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/scene/scene.h"

#include <array>
#include <vector>

namespace hone {

/// IEC 61966-2-1: the linear value in [0,1] of each 8-bit sRGB code.
[[nodiscard]] const std::array<float, 256>& srgbTable();

/// A scene's arrays in a device's memory, bound to kernels by the names of surface.glsl.h:
/// scene_positions, scene_normals, scene_uvs, scene_triangles, scene_meshes, scene_instances,
/// scene_materials, scene_textures, scene_texels, scene_srgb (256 decoded values), scene_lights,
/// scene_probes, scene_environment. An empty array is bound as one zeroed element.
class SceneBuffers {
public:
    /// Copies the arrays of `scene` (finished) to `device`. Throws OutOfMemory, DeviceError.
    SceneBuffers(Device& device, const Scene& scene);
    /// Follows instances that moved (moveInstance); no work that reads them may be pending.
    void update(const Scene& scene);
    [[nodiscard]] std::span<const Argument> arguments() const { return arguments_; }
    [[nodiscard]] BufferView find(std::string_view name) const;
    [[nodiscard]] std::size_t bytes() const;

private:
    std::vector<Buffer> buffers_;
    std::vector<Argument> arguments_;
};

} // namespace hone

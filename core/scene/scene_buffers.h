// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/device/memory_copy.h"
#include "hone/core/scene/scene.h"

#include <vector>

namespace hone {

/// A scene's arrays as a device's buffers, bound to kernels by the names of forEachSceneArray():
/// scene_positions, scene_triangles and so on. An empty array is bound as one zeroed element.
///
/// The device uses the scene's own bytes (Device::importBuffer); an array that it cannot use where
/// it is, it gets as a copy. So no array of the scene may grow, shrink or move while this lives,
/// and kernels must not write to them.
class SceneBuffers {
public:
    /// Borrows the arrays of `scene` (finished). Throws OutOfMemory, DeviceError.
    SceneBuffers(Device& device, const Scene& scene);
    /// Follows instances that moved (moveInstance): writes anew what is copied; what is imported
    /// has followed already. No work that reads the scene may be pending.
    void update(const Scene& scene);
    [[nodiscard]] std::span<const Argument> arguments() const { return arguments_; }
    [[nodiscard]] BufferView find(std::string_view name) const;
    /// What the device took memory for: copies, and what stands for empty arrays.
    [[nodiscard]] std::size_t bytes() const;
    /// The arrays that exist twice, for the device could not import them.
    [[nodiscard]] std::span<const MemoryCopy> copies() const { return copies_; }

private:
    std::vector<Buffer> buffers_;
    std::vector<Argument> arguments_;
    std::vector<MemoryCopy> copies_;
    std::size_t bytes_ = 0;
};

} // namespace hone

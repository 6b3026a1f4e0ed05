// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/trace/instancing.h"
#include "hone/core/trace/trace_backend.h"

namespace hone {

/// The kinds of ray tracing that a device was opened with. Each is there without the other on some
/// devices.
struct RayTracing {
    bool query = false;    ///< VK_KHR_ray_query
    bool pipeline = false; ///< VK_KHR_ray_tracing_pipeline
};

/// Neither for a device that makeVulkanDevice() did not make.
[[nodiscard]] RayTracing rayTracing(const Device& device);

struct RayTracerParams {
    /// As EmbreeParams has it: triangles that copies of meshes may add to the flat trees.
    std::size_t flatten_triangles = kFlattenTriangles;
    /// On a software device each flattened instance gets a tree of its own if the scene has at most
    /// so many: Mesa's builds order triangles along one curve, where large ones spoil the boxes of
    /// their neighbours, so that trees apart are 1.2 to 1.7 times as fast. GPUs are slower where
    /// trees overlap.
    std::size_t most_apart = 1024;
};

/// Ray queries from a compute shader, `vulkan.ray_query`. Borrows `device`.
///
/// Trees are the driver's (VK_KHR_acceleration_structure), over world-space triangles as
/// worldPosition() places them. Of closest hits of equal t the one that the driver comes to first
/// is answered: the same at every query of the same tree, but an update may change which. Instances
/// that moved far leave boxes that overlap, so that queries get slower; build() makes them anew.
/// Throws DeviceError if `device`
/// is no Vulkan device or was opened without ray queries, OutOfMemory.
[[nodiscard]] std::unique_ptr<TraceBackend> makeRayQueryTracer(Device& device,
                                                               const RayTracerParams& params = {});
/// The same through a pipeline of ray generation, hit and miss shaders, `vulkan.ray_pipeline`: for
/// devices that offer no ray query, and for comparison.
[[nodiscard]] std::unique_ptr<TraceBackend>
makeRayPipelineTracer(Device& device, const RayTracerParams& params = {});

} // namespace hone

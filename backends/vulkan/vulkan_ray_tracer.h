// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_scene_tree.h"
#include "hone/backends/vulkan/vulkan_tracers.h"
#include "hone/core/scene/scene_buffers.h"
#include "hone/core/trace/query_memory.h"

#include <memory>
#include <optional>
#include <string>

namespace hone {

/// Throws DeviceError that says what the device lacks for `tracer` and what to use instead, unless
/// it `is_there`.
void requireRays(Device& device, bool is_there, const char* tracer, const char* extension);

/// What ray queries and ray pipelines have in common: everything but the shaders.
class VulkanRayTracer final : public TraceBackend {
public:
    /// Records the tracing of `count` rays.
    using Shoot = void (*)(VulkanEncoder& encoder, const Arguments& arguments,
                           const TraceParams& params, uint count);

    /// Borrows `device`, which must be a Vulkan device that was opened for what `shoot` does.
    VulkanRayTracer(Device& device, std::string name, Shoot shoot, const RayTracerParams& params);

    [[nodiscard]] TraceCaps caps() const override;
    using TraceBackend::build;
    BuildStats build(const Scene& scene, const SceneBuffers* shared) override;
    BuildStats update(std::span<const uint> moved) override;
    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override;
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override;

    [[nodiscard]] std::size_t copiedBytes() const override { return memory_.copiedBytes(); }

private:
    void makeTree(bool is_refitted);
    [[nodiscard]] BuildStats stats(double ms) const;
    /// Traces the rays that memory_ is bound to, a chunk at a time.
    void trace(std::size_t count, bool is_occluded) const;

    Device* device_;
    std::string name_;
    Shoot shoot_;
    RayTracerParams params_;
    const Scene* scene_ = nullptr;
    const SceneBuffers* scene_buffers_ = nullptr; ///< null: the scene has no masked materials
    std::optional<SceneBuffers> own_buffers_;
    std::optional<VulkanSceneTree> tree_;
    mutable QueryMemory memory_;
};

} // namespace hone

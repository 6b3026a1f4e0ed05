// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_ray_tracer.h"

#include "hone/core/error.h"

#include <algorithm>
#include <chrono>

namespace hone {
namespace {

/// Rays of one submission. A software device answers some 100,000 a second, and a GPU's watchdog
/// must never see a long one. Rays of a chunk fit what every device binds at once (128 MiB).
constexpr std::size_t kSoftwareChunk = std::size_t{1} << 16;
constexpr std::size_t kChunk = std::size_t{1} << 21;

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

bool hasMasks(const Scene& scene) {
    return std::ranges::any_of(scene.meshes, [&](const Mesh& mesh) {
        return (scene.materials[mesh.material].flags & kMaterialMasked) != 0;
    });
}

/// What isSolid() reads.
constexpr std::string_view kMaskBuffers[] = {
    "scene_positions", "scene_normals",   "scene_uvs",      "scene_triangles", "scene_meshes",
    "scene_instances", "scene_materials", "scene_textures", "scene_texels",    "scene_srgb"};

} // namespace

void requireRays(Device& device, bool is_there, const char* tracer, const char* extension) {
    if (is_there)
        return;
    const DeviceInfo& info = device.info();
    const std::string lacks = insideOf(device).resources == nullptr
                                  ? " is no Vulkan device"
                                  : " (" + info.driver + ") was opened without " + extension;
    throw DeviceError(std::string(tracer) + ": " + info.name + lacks +
                      "; trace with vulkan, which takes what there is, or with embree");
}

VulkanRayTracer::VulkanRayTracer(Device& device, std::string name, Shoot shoot,
                                 const RayTracerParams& params)
    : device_(&device), name_(std::move(name)), shoot_(shoot), params_(params), memory_(device) {}

TraceCaps VulkanRayTracer::caps() const {
    return {.name = name_,
            .version = device_->info().driver,
            .runs_on = device_->info().name,
            .memory = TraceMemory::kDevice,
            .always_exact = true,
            .updates = true};
}

BuildStats VulkanRayTracer::build(const Scene& scene, const SceneBuffers* shared) {
    const auto begin = Clock::now();
    tree_.reset(); // the old one's memory first
    own_buffers_.reset();
    scene_ = &scene;
    scene_buffers_ = nullptr;
    if (hasMasks(scene)) {
        scene_buffers_ = shared;
        if (shared == nullptr)
            scene_buffers_ = &own_buffers_.emplace(*device_, scene);
    }
    makeTree(false);
    return stats(msSince(begin));
}

BuildStats VulkanRayTracer::update(std::span<const uint> moved) {
    HONE_ASSERT(tree_.has_value(), "build() comes before update()");
    const auto begin = Clock::now();
    if (moved.empty())
        return stats(0);
    if (own_buffers_)
        own_buffers_->update(*scene_);
    // Most scenes stand still: the first move pays for a tree that can follow.
    if (!tree_->isRefitted() || !tree_->update(moved))
        makeTree(true);
    return stats(msSince(begin));
}

void VulkanRayTracer::makeTree(bool is_refitted) {
    tree_.reset();
    tree_.emplace(*device_, *scene_, params_, is_refitted);
}

BuildStats VulkanRayTracer::stats(double ms) const {
    std::size_t copied = tree_->copiedBytes();
    if (own_buffers_)
        for (const MemoryCopy& array : own_buffers_->copies())
            copied += array.bytes;
    return {
        .ms = ms, .triangles = tree_->triangles(), .bytes = tree_->bytes(), .copied_bytes = copied};
}

void VulkanRayTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence,
                              const TraceOptions&) const {
    HONE_ASSERT(rays.size() == hits.size(), "one hit a ray");
    HONE_ASSERT(tree_.has_value(), "build() comes before the first query");
    if (tree_->empty()) {
        std::ranges::fill(hits, Hit{kNone, kNone});
        return;
    }
    memory_.bind(rays, std::as_writable_bytes(hits));
    trace(rays.size(), false);
    memory_.collect();
}

void VulkanRayTracer::occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence,
                               const TraceOptions&) const {
    HONE_ASSERT(rays.size() == occluded.size(), "one answer a ray");
    HONE_ASSERT(tree_.has_value(), "build() comes before the first query");
    if (tree_->empty()) {
        std::ranges::fill(occluded, 0u);
        return;
    }
    memory_.bind(rays, std::as_writable_bytes(occluded));
    trace(rays.size(), true);
    memory_.collect();
}

void VulkanRayTracer::trace(std::size_t count, bool is_occluded) const {
    Arguments arguments;
    tree_->bind(arguments);
    if (scene_buffers_ != nullptr)
        arguments.bind(scene_buffers_->arguments());
    else // no candidate ever asks
        for (const std::string_view name : kMaskBuffers)
            arguments.bind(name, {});

    const std::size_t words = is_occluded ? 1 : sizeof(Hit) / sizeof(uint);
    const std::size_t chunk = device_->info().is_software ? kSoftwareChunk : kChunk;
    VulkanEncoder& encoder = *insideOf(*device_).encoder;
    for (std::size_t first = 0; first < count; first += chunk) {
        const std::size_t rays = std::min(chunk, count - first);
        const TraceParams params{
            .tree = tree_->address(),
            .first_ray = bindStretch<Ray>(arguments, "rays", memory_.rays(), first, rays),
            .first_answer = bindStretch<uint>(arguments, "answers", memory_.answers(),
                                              first * words, rays * words),
            .is_occluded = is_occluded ? 1u : 0u};
        shoot_(encoder, arguments, params, static_cast<uint>(rays));
        encoder.finish();
    }
}

} // namespace hone

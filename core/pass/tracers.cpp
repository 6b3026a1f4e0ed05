// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/core/pass/pass.h"

#include <algorithm>
#include <cstring>

namespace hone {
namespace {

/// Which of the instances were placed elsewhere, ascending.
std::vector<uint> movedInstances(std::span<const Instance> before, std::span<const Instance> now) {
    std::vector<uint> moved;
    for (uint i = 0; i < now.size(); ++i)
        if (std::memcmp(&before[i], &now[i], sizeof(Instance)) != 0)
            moved.push_back(i);
    return moved;
}

void requireMasks(const TraceBackend& backend, std::string_view name, const Scene& scene) {
    if (hasMasked(scene) && !backend.caps().masked)
        throw DeviceError("trace backend \"" + std::string(name) +
                          "\" does not honour alpha-masked materials, which scene \"" + scene.name +
                          "\" has; set parameter \"backend\" to \"auto\"");
}

} // namespace

/// What "auto" stands for.
TracerChoice& Tracers::choose(const Scene& scene) {
    if (masked_version_ != scene.version) {
        is_masked_ = hasMasked(scene);
        masked_version_ = scene.version;
    }
    TracerChoice& choice = choices_[is_masked_ ? 1 : 0];
    if (choice.name.empty()) {
        choice = chooseTracer(*registry_, devices_, is_masked_);
        logger().info("trace backend {}: {}", choice.name, choice.reason);
    }
    return choice;
}

Tracers::Resolved Tracers::resolve(std::string_view backend, const Scene& scene) {
    if (backend != "auto")
        return {backend, "asked for by name"};
    const TracerChoice& choice = choose(scene);
    return {choice.name, choice.reason};
}

std::unique_ptr<TraceBackend> Tracers::make(std::string_view backend, const Scene& scene) {
    const std::string_view name = resolve(backend, scene).name;
    // The one that was tried need not be made again.
    std::unique_ptr<TraceBackend> made;
    if (backend == "auto")
        made = std::move(choose(scene).backend);
    if (made != nullptr)
        made = registry_->wrap(std::move(made));
    else
        made = registry_->create(name, devices_);
    requireMasks(*made, name, scene);
    return made;
}

TraceBackend& Tracers::get(std::string_view backend, const Value& scene_value) {
    const Scene& scene = *scene_value.scene;
    const std::string_view name = resolve(backend, scene).name;
    auto found = std::ranges::find(built_, name, &Built::name);
    if (found == built_.end())
        found =
            built_.insert(built_.end(), Built{std::string(name), make(backend, scene), 0, 0, {}});
    if (found->version == scene.version)
        return *found->backend;

    requireMasks(*found->backend, name, scene);
    // If it fails halfway, the next call builds anew.
    const bool only_moved = found->version != 0 && found->shape_version == scene.shape_version;
    found->version = 0;
    if (only_moved)
        found->backend->update(movedInstances(found->instances, scene.instances));
    else
        found->copied_bytes = found->backend->build(scene, scene_value.scene_buffers).copied_bytes;
    found->version = scene.version;
    found->shape_version = scene.shape_version;
    found->instances.assign(scene.instances.begin(), scene.instances.end());
    return *found->backend;
}

std::vector<MemoryCopy> Tracers::copies() const {
    std::vector<MemoryCopy> copies;
    for (const Built& built : built_) {
        if (built.copied_bytes > 0)
            copies.push_back({"the scene in " + built.name, built.copied_bytes,
                              built.name + " keeps arrays of the scene in a memory of its own",
                              "another trace backend; hone bench tracers compares them"});
        if (const std::size_t bytes = built.backend->copiedBytes(); bytes > 0)
            copies.push_back({"rays and answers of " + built.name, bytes,
                              built.name + " cannot use the memory that they lay in",
                              "passes that keep their lists in buffers of PassContext::memory, or "
                              "another trace backend"});
    }
    return copies;
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/scene_buffers.h"

#include "hone/core/error.h"
#include "hone/core/scene/scene_arrays.h"

#include <algorithm>
#include <cstring>

namespace hone {

SceneBuffers::SceneBuffers(Device& device, const Scene& scene) {
    forEachSceneArray(scene, [&]<class T>(std::string_view name, std::span<const T> elements) {
        // Buffers are made for kernels that write too; a scene's are only read.
        T* data = const_cast<T*>(elements.data());
        Buffer buffer;
        if (!elements.empty())
            buffer =
                device.importBuffer(std::as_writable_bytes(std::span(data, elements.size())), name);
        const bool is_imported = static_cast<bool>(buffer);
        if (!is_imported) {
            buffer =
                device.createBuffer(std::max<std::size_t>(elements.size_bytes(), sizeof(T)), name);
            bytes_ += buffer.bytes();
        }
        arguments_.push_back({name, buffer.view()});
        if (!is_imported && !elements.empty()) {
            copies_.push_back({std::string(name), elements.size_bytes(),
                               device.info().name + " cannot use memory of the host where it is",
                               "a device that imports host memory; hone doctor says which do"});
            std::memcpy(buffer.view().data, elements.data(), elements.size_bytes());
        }
        buffers_.push_back(std::move(buffer));
    });
}

void SceneBuffers::update(const Scene& scene) {
    const std::span<const Instance> instances(scene.instances);
    const BufferView buffer = find("scene_instances");
    if (!instances.empty() && buffer.as<Instance>().data() != instances.data())
        std::memcpy(buffer.data, instances.data(), instances.size_bytes());
}

BufferView SceneBuffers::find(std::string_view name) const {
    for (const Argument& argument : arguments_)
        if (argument.name == name)
            return argument.buffer;
    HONE_ASSERT(false, "a scene has no buffer " + std::string(name));
}

std::size_t SceneBuffers::bytes() const {
    return bytes_;
}

} // namespace hone

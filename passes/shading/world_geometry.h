// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/scene/scene.h"

#include <vector>

namespace hone {

/// A scene's vertices where they are in the world, and its clusters with their bounds there: what
/// the rasteriser draws from. A vertex is placed once a scene, not once a view.
class WorldGeometry {
public:
    /// A cluster of one instance. Bounding sphere in world space.
    struct PlacedCluster {
        vec3 center;
        float radius;
        uint instance;
        uint cluster; ///< in Scene::clusters
    };

    /// Follows `scene` (finished); does nothing while its version stays. Throws OutOfMemory,
    /// DeviceError.
    void update(Device& device, const Scene& scene);

    [[nodiscard]] std::span<const PlacedCluster> clusters() const { return clusters_; }
    /// World positions, vec3 by world vertex.
    [[nodiscard]] BufferView positions() const { return positions_.view(); }
    /// Add to a vertex of Scene::triangles for the instance's world vertex. Wraps around.
    [[nodiscard]] uint vertexOffset(uint instance) const { return vertex_offsets_[instance]; }

private:
    Buffer positions_;
    std::vector<uint> vertex_offsets_;
    std::vector<PlacedCluster> clusters_;
    std::uint64_t version_ = 0;
};

} // namespace hone

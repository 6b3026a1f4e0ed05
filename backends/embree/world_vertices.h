// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/host_surface.h"
#include "hone/core/scene/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hone {

/// The vertices of the instances that stand in a flat tree, each numbered as Scene::positions are,
/// so that a tracer reads the scene's own triangles as its indices.
///
/// An instance that is placed nowhere else than its mesh (identity) has the scene's own positions
/// for vertices until it moves. The others' are derived data in one array: at the numbers of their
/// positions where no other instance uses these, else in a stretch of its own behind, as long as
/// from the least number to the greatest that its mesh uses.
class WorldVertices {
public:
    /// Finds a place for each instance whose mesh is not `is_instanced`. Borrows both arguments.
    WorldVertices(const Scene& scene, const HostSurface& surface,
                  std::span<const std::uint8_t> is_instanced);

    /// Writes where the vertices of an instance stand now, and returns the array that the mesh's
    /// triangles index. Only the elements that they name are worth reading; 16 bytes behind the
    /// last may be read, too. The place of an instance stays the same from its first move on.
    std::span<const vec3> place(uint instance);

    /// Of derived vertices.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    struct Place {
        std::size_t first = 0; ///< of its array in world_
        std::size_t count = 0; ///< elements of its array, which begins with what is not its own
        std::size_t own = 0;   ///< vertices that are its own; 0 once they are counted in bytes_
        bool has_moved = false;
    };
    [[nodiscard]] std::span<const uvec3> trianglesOf(uint instance) const;

    const Scene* scene_;
    const HostSurface* surface_;
    std::vector<Place> places_; ///< by instance
    /// Not initialised: stretches that nobody writes to take no memory.
    std::unique_ptr<vec3[]> world_;
    std::size_t bytes_ = 0;
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/host_surface.h"

#include <array>
#include <vector>

namespace hone {

/// Triangles that a tree is built from, with the hit that each stands for. Corners turn
/// counter-clockwise seen from the front.
struct TriangleSoup {
    std::vector<std::array<vec3, 3>> corners;
    std::vector<Hit> names;

    /// Appends the triangles of an instance, in the world, at the very vertices that shading uses.
    /// Triangles without area, which no ray may hit, are left out.
    void addInstance(const Scene& scene, const HostSurface& surface, uint instance);
    /// Appends a mesh's triangles in its own space; the instance of their names is kNone.
    void addMesh(const Scene& scene, uint mesh);

private:
    void add(std::array<vec3, 3> triangle, Hit name);
};

} // namespace hone

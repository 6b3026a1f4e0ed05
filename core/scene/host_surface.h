// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/kernel.glsl.h"
#include "hone/core/scene/scene.h"

namespace hone {

/// The functions of surface.glsl.h over a scene's own arrays, without a device: what a tracer on
/// the host asks for world positions and alpha, in the arithmetic that shading uses.
///
/// Borrows `scene`, whose arrays must neither move nor change while this is used. Safe to call from
/// many threads.
class HostSurface {
public:
    explicit HostSurface(const Scene& scene) : kernel_(bind(scene)) {}

    /// Where `vertex` (a number in Scene::positions) of `instance` stands in the world.
    [[nodiscard]] vec3 worldPosition(const Instance& instance, uint vertex) const {
        return kernel_.worldPosition(instance, vertex);
    }
    /// Whether the point that `ray` sees on the triangle `hit` is solid, not a hole of a mask.
    [[nodiscard]] bool isSolid(const Ray& ray, Hit hit) const { return kernel_.isSolid(ray, hit); }

private:
    struct SurfaceKernel : HostKernel {
        // Arguments are read only while the members below are made.
        explicit SurfaceKernel(const Arguments& arguments) : HostKernel(arguments, nullptr) {}

#include "hone/core/scene/texture.glsl.h"

#include "hone/core/scene/surface.glsl.h"
    };

    static Arguments bind(const Scene& scene);

    mutable SurfaceKernel kernel_; // its functions cannot say const, but change nothing
};

} // namespace hone

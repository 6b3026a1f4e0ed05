// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"

#include <span>
#include <vector>

namespace hone::test {

/// White, opaque, single-sided.
[[nodiscard]] Material plainMaterial(uint flags = 0);

/// Makes small scenes for tests. Numbers that the add functions return count up from 0.
class SceneBuilder {
public:
    /// One mip level, clamped (see Texture::wrap_u for `wrap`).
    uint addTexture(uint width, uint height, std::span<const uint> texels, uint wrap = 1);
    uint addMaterial(const Material& material);
    /// `triangles` index `positions`. Texture coordinates are (0,0) where `uvs` is empty.
    uint addMesh(std::span<const vec3> positions, std::span<const uvec3> triangles, uint material,
                 std::span<const vec2> uvs = {});
    uint addInstance(uint mesh, const mat4& to_world = mat4(1.0f));
    /// A mesh placed as it is. Returns the instance.
    uint add(std::span<const vec3> positions, std::span<const uvec3> triangles, uint material,
             std::span<const vec2> uvs = {});

    /// The scene so far, ready to be drawn and traced: as finishScene() does, with one cluster a
    /// mesh, but triangles keep the order in which they were added, so that tests know their
    /// numbers.
    [[nodiscard]] Scene finish() const;

private:
    Scene scene_;
};

} // namespace hone::test

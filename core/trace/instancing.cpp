// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/instancing.h"

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hone {

bool isInvertible(const Instance& instance) {
    // Not from normal_matrix: that of a flattening matrix holds cofactors, which are finite.
    const glm::dmat3 linear(instance.to_world[0], instance.to_world[1], instance.to_world[2]);
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const double determinant = std::fabs(glm::dot(linear[0], cofactors[0]));
    constexpr double kLimit = 1e6;
    for (int column = 0; column < 3; ++column) // no NaN is below the limit
        for (int row = 0; row < 3; ++row)
            if (!(std::fabs(cofactors[column][row]) < kLimit * determinant))
                return false;
    return true;
}

std::vector<std::uint8_t> chooseInstanced(const Scene& scene, std::size_t flatten_triangles) {
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    std::vector<std::uint8_t> may_instance(scene.meshes.size(), 1);
    for (const Instance& instance : scene.instances) {
        ++uses[instance.mesh];
        if (!isInvertible(instance))
            may_instance[instance.mesh] = 0;
    }
    auto added = [&](uint mesh) {
        return uses[mesh] > 1 ? (uses[mesh] - 1) * scene.meshes[mesh].triangle_count : 0;
    };
    std::vector<uint> order(scene.meshes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, added);

    std::vector<std::uint8_t> is_instanced(scene.meshes.size(), 0);
    std::size_t total = 0;
    for (const uint mesh : order) {
        total += added(mesh);
        if (added(mesh) > 0 && total > flatten_triangles)
            is_instanced[mesh] = may_instance[mesh];
    }
    return is_instanced;
}

} // namespace hone

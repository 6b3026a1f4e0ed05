// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/bvh/binned_builder.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace hone {
namespace {

constexpr uint kBins = 16;
/// Below this depth primitives are halved, which ends after at most 32 more.
constexpr uint kHalvingDepth = 60;
static_assert(kHalvingDepth + 32 <= kBvhDepth);

/// Primitives [begin, end) of the order, which become a node.
struct Range {
    uint begin, end;
    uint depth;
    uint parent; ///< whose right child it is; kNone: a left one, or the root
};

void grow(Bounds& bounds, const Bounds& other) {
    bounds.low = glm::min(bounds.low, other.low);
    bounds.high = glm::max(bounds.high, other.high);
}

/// A plane between two bins of an axis.
struct Split {
    float cost = std::numeric_limits<float>::infinity(); ///< area times primitives, both sides
    uint axis = 0;
    uint bin = 0; ///< the first of the upper side
};

/// Which bin of `axis` a centre falls into.
class Bins {
public:
    explicit Bins(const Bounds& centers) : low_(centers.low) {
        const vec3 size = centers.high - centers.low;
        for (int axis = 0; axis < 3; ++axis)
            scale_[axis] = size[axis] > 0.0f ? static_cast<float>(kBins) / size[axis] : 0.0f;
    }
    [[nodiscard]] bool canSplit(uint axis) const { return scale_[static_cast<int>(axis)] > 0.0f; }
    [[nodiscard]] uint of(const Bounds& box, uint axis) const {
        const auto k = static_cast<int>(axis);
        const float place = (box.center()[k] - low_[k]) * scale_[k];
        return static_cast<uint>(std::clamp(place, 0.0f, static_cast<float>(kBins - 1)));
    }

private:
    vec3 low_;
    vec3 scale_{0.0f};
};

class Builder {
public:
    explicit Builder(const BvhInput& input) : input_(input) {
        bvh_.order.resize(input.boxes.size());
        std::iota(bvh_.order.begin(), bvh_.order.end(), 0u);
    }

    Bvh build() {
        std::vector<Range> stack;
        if (!bvh_.order.empty())
            stack.push_back({0, static_cast<uint>(bvh_.order.size()), 0, kNone});
        while (!stack.empty()) {
            const Range range = stack.back();
            stack.pop_back();
            const auto index = static_cast<uint>(bvh_.nodes.size());
            if (range.parent != kNone)
                bvh_.nodes[range.parent].link = index;
            Bvh::Node& node = bvh_.nodes.emplace_back();
            Bounds centers;
            for (uint i = range.begin; i < range.end; ++i) {
                const Bounds& box = input_.boxes[bvh_.order[i]];
                grow(node.bounds, box);
                centers.add(box.center());
            }
            const uint middle = divide(range, node, centers);
            if (middle == range.begin) {
                node.link = range.begin;
                node.count = range.end - range.begin;
                continue;
            }
            // The left child is taken next, so that it lies next.
            stack.push_back({middle, range.end, range.depth + 1, index});
            stack.push_back({range.begin, middle, range.depth + 1, kNone});
        }
        return std::move(bvh_);
    }

private:
    /// Orders the range into a lower and an upper part along node.axis; returns where the upper
    /// begins, or range.begin for a leaf.
    uint divide(const Range& range, Bvh::Node& node, const Bounds& centers) {
        const uint count = range.end - range.begin;
        if (count == 1)
            return range.begin;
        const Bins bins(centers);
        const Split split = range.depth < kHalvingDepth ? bestSplit(range, bins) : Split{};

        // One box test more against one triangle test less a primitive.
        const float leaf_cost = halfArea(node.bounds) * static_cast<float>(count);
        if (count <= input_.leaf_size && !(split.cost + 2 * halfArea(node.bounds) < leaf_cost))
            return range.begin;
        const auto begin = bvh_.order.begin() + range.begin;
        const auto end = bvh_.order.begin() + range.end;
        if (split.cost < std::numeric_limits<float>::infinity()) {
            node.axis = split.axis;
            const auto middle = std::partition(begin, end, [&](uint primitive) {
                return bins.of(input_.boxes[primitive], split.axis) < split.bin;
            });
            return static_cast<uint>(middle - bvh_.order.begin());
        }

        // No plane parts the centres: halve the primitives along the longest axis.
        const vec3 size = centers.high - centers.low;
        node.axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const uint middle = range.begin + count / 2;
        std::nth_element(begin, bvh_.order.begin() + middle, end, [&](uint a, uint b) {
            const auto axis = static_cast<int>(node.axis);
            const float center_a = input_.boxes[a].center()[axis];
            const float center_b = input_.boxes[b].center()[axis];
            return center_a != center_b ? center_a < center_b : a < b;
        });
        return middle;
    }

    [[nodiscard]] Split bestSplit(const Range& range, const Bins& bins) const {
        struct Bin {
            Bounds bounds;
            uint count = 0;
        };
        std::array<std::array<Bin, kBins>, 3> filled{};
        for (uint i = range.begin; i < range.end; ++i) {
            const Bounds& box = input_.boxes[bvh_.order[i]];
            for (uint axis = 0; axis < 3; ++axis) {
                Bin& bin = filled[axis][bins.of(box, axis)];
                grow(bin.bounds, box);
                ++bin.count;
            }
        }
        Split best;
        for (uint axis = 0; axis < 3; ++axis) {
            if (!bins.canSplit(axis))
                continue;
            // Area times primitives of all bins from each on; then sweep up from below.
            std::array<float, kBins> upper{};
            Bin sum;
            for (uint bin = kBins; bin-- > 1;) {
                grow(sum.bounds, filled[axis][bin].bounds);
                sum.count += filled[axis][bin].count;
                upper[bin] = halfArea(sum.bounds) * static_cast<float>(sum.count);
            }
            const uint count = range.end - range.begin;
            sum = {};
            for (uint bin = 1; bin < kBins; ++bin) {
                grow(sum.bounds, filled[axis][bin - 1].bounds);
                sum.count += filled[axis][bin - 1].count;
                const float cost =
                    halfArea(sum.bounds) * static_cast<float>(sum.count) + upper[bin];
                if (sum.count > 0 && sum.count < count && cost < best.cost)
                    best = {cost, axis, bin};
            }
        }
        return best;
    }

    const BvhInput& input_;
    Bvh bvh_;
};

} // namespace

Bvh buildBinnedBvh(const BvhInput& input) {
    return Builder(input).build();
}

} // namespace hone

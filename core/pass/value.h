// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/buffer.h"
#include "hone/core/math.h"
#include "hone/core/pass/port_type.h"
#include "hone/core/scene/scene.h"

#include <string>
#include <vector>

namespace hone {

class SceneBuffers;

/// One iteration of a loop, for curves and progress.
struct LoopRecord {
    uint iteration = 0;       ///< from 1
    std::uint64_t pixels = 0; ///< requested so far
    std::uint64_t rays = 0;   ///< traced so far, all kinds
    double ms = 0;            ///< since the loop began
    float worst_expect =
        0; ///< greatest expected error of this iteration's pixels; 0 if no order carries errors
};

/// What a loop did and why it ended.
struct Curve {
    std::vector<LoopRecord> records;
    std::string stop; ///< the rule that ended it: "empty", "rays", "ms", "iterations", "cancelled"
};

/// What flows along an edge while a graph runs. Plain data; the executor owns the memory.
struct Value {
    const PortType* type = nullptr;
    BufferView buffer;  ///< planes, lists, records
    uint count = 0;     ///< valid elements; planes: width * height
    uvec2 extent{0, 0}; ///< planes and kExtent
    const Scene* scene = nullptr;
    const SceneBuffers* scene_buffers = nullptr;
    const Camera* camera = nullptr;
    Curve* curve = nullptr;
    /// Changes whenever the content does; what incremental execution compares. 0 = never written.
    std::uint64_t version = 0;

    template <class T> [[nodiscard]] std::span<T> as() const { return buffer.as<T>().first(count); }
    /// All the elements that fit, valid or not: what a pass that fills a list writes to.
    template <class T> [[nodiscard]] std::span<T> capacity() const { return buffer.as<T>(); }
};

} // namespace hone

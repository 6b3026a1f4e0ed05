// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/scene/scene.h"
#include "hone/core/trace/trace_slices.h"

namespace hone {

/// A small scene and rays through it, the same everywhere: what trace backends are compared with,
/// on the machine that they are to run on.
///
/// 18432 triangles of rolling hills; 16384 each of primary rays in order, shadow rays to a light,
/// and rays that go anywhere.
class Calibration {
public:
    /// Lists lie in the buffers of `memory`, as those of passes do.
    explicit Calibration(Device& memory);

    /// How many rays a second `backend` answers, the kinds together: the best of three rounds, or
    /// of what 100 ms allow. Builds the backend for its own scene, so build it again before the
    /// next use. Throws what the backend throws.
    [[nodiscard]] double raysPerSecond(TraceBackend& backend) const;

private:
    [[nodiscard]] std::size_t traceAll(const TraceBackend& backend, TraceSlices& slices,
                                       const Interrupt& limit) const;

    Scene scene_;
    Buffer primary_, shadow_, scattered_; ///< Ray
    Buffer hits_, occluded_;
};

} // namespace hone

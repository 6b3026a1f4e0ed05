// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/trace/bvh.h"
#include "hone/core/trace/instancing.h"
#include "hone/core/trace/trace_backend.h"

#include <string>

namespace hone {

struct BvhParams {
    std::string name = "bvh"; ///< what caps() say
    /// Triangles that copies of meshes may add to the world's tree (instancing.h).
    std::size_t flatten_triangles = kFlattenTriangles;
    /// Boxes and triangles that one dispatch tests for a ray; what is not done then is dispatched
    /// again. Drivers end what runs for seconds, and Mesa 22.3.6 was seen to cut loops short after
    /// 65535 turns (other kernels' loops; not this one's, which are nested).
    uint step_limit = 16'384;
};

/// A tracer in kernels, on any device: a BVH that is traversed without a stack along skip links,
/// nearer children first.
///
/// Each ray is answered as if it were alone. Rays that lie in the device's buffers are read there,
/// and answers written, without a copy. Borrows `device`. What a scene's nodes or triangles need
/// must fit into what a kernel can read of one buffer (DeviceInfo::max_binding_bytes), else build()
/// throws DeviceError: 96 bytes a triangle and more where boxes are cut.
[[nodiscard]] std::unique_ptr<TraceBackend> makeBvhTracer(Device& device, BvhBuilder builder,
                                                          const BvhParams& params = {});

} // namespace hone

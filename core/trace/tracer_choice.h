// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

#include <memory>
#include <string>

namespace hone {

/// Whether anything in the scene has a masked material: what TraceCaps::masked is needed for.
[[nodiscard]] bool hasMasked(const Scene& scene);

/// A trace backend that was picked, and why, for people: "fastest of embree 18.2, vulkan.ray_query
/// 240 Mray/s".
struct TracerChoice {
    std::string name;
    std::string reason;
    std::unique_ptr<TraceBackend> backend; ///< not built
};

/// What "auto" stands for: the fastest backend that can be made on these devices and trace such
/// scenes.
///
/// Left out without a trial are references, and tracers of a software Vulkan device: they would
/// share the cores with a tracer of the host that is far faster. (Where nothing else is there, they
/// are taken after all, the latter first.) If several are left, each is timed for about 100 ms
/// (Calibration). Backends agree but for ties and rounding at edges; who needs the same bits on
/// another machine names one. Throws DeviceError that says of each why it cannot.
[[nodiscard]] TracerChoice chooseTracer(const TraceBackendRegistry& registry,
                                        const Devices& devices, bool masked);

} // namespace hone

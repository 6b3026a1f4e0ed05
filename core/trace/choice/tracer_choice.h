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
/// Only processors compete. Of the backends that share the host's cores the first that was
/// registered is taken, and its rivals are never built: references and tracers of a software Vulkan
/// device only where nothing else is there (the latter first). If backends on hardware devices are
/// there, too, each is timed for about 100 ms (Calibration). Backends agree but for ties and
/// rounding at edges; who needs the same bits on another machine names one.
///
/// Throws DeviceError that says of each why it cannot.
[[nodiscard]] TracerChoice chooseTracer(const TraceBackendRegistry& registry,
                                        const Devices& devices, bool masked);

} // namespace hone

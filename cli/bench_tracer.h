// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

#include <array>
#include <memory>
#include <vector>

namespace hone::cli {

/// The rays of one kind that a frame asked for, in its order; without those that can hit nothing,
/// which passes put where a path needs no ray.
struct RayList {
    const char* kind = "";
    bool is_occlusion = false;
    Coherence coherence = Coherence::kIncoherent;
    std::vector<Ray> rays;
};

/// What passes asked of a tracer.
struct RayRecord {
    vec3 eye{0, 0, 0}; ///< closest-hit rays that start here are primary
    bool keeps_rays = false;
    double ms = 0; ///< inside the tracer, since someone set it to 0
    RayList primary{"primary", false, Coherence::kIncoherent, {}};
    RayList shadow{"shadow", true, Coherence::kIncoherent, {}};
    RayList mirror{"mirror", false, Coherence::kIncoherent, {}};
    RayList mirror_shadow{
        "mirror_shadow", true, Coherence::kIncoherent, {}}; ///< from what mirrors show
    bool is_past_mirror = false; ///< the last closest hits were seen in mirrors

    [[nodiscard]] std::array<RayList*, 4> lists() {
        return {&primary, &shadow, &mirror, &mirror_shadow};
    }
    void clear();
};

/// A tracer that answers as `inner` does, and writes down what it was asked. `record` must outlive
/// it.
[[nodiscard]] std::unique_ptr<TraceBackend> makeRecordingTracer(std::unique_ptr<TraceBackend> inner,
                                                                RayRecord& record);

} // namespace hone::cli

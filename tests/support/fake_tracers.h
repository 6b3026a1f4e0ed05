// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hone::test {

/// Knows no geometry: ray i hits (tmin of ray i, 7), and is occluded if that number is odd. As slow
/// as is wished, on the clock, not on the cores.
class FakeTracer : public TraceBackend {
public:
    explicit FakeTracer(TraceCaps caps = {.name = "fake", .version = "1", .runs_on = "host"})
        : caps_(std::move(caps)) {}

    double us_per_ray = 0;
    std::function<void()> on_query;           ///< called before each query; may throw
    mutable std::vector<std::size_t> lengths; ///< of the lists that were asked for
    int builds = 0;

    TraceCaps caps() const override { return caps_; }
    BuildStats build(const Scene& scene, const SceneBuffers* shared) override;
    BuildStats update(std::span<const uint> moved) override;
    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override;
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override;

    /// `count` rays that are told apart by their tmin: 0, 1, 2, ...
    [[nodiscard]] static std::vector<Ray> rays(std::size_t count);

private:
    void answerSlowly(std::size_t rays) const;
    TraceCaps caps_;
};

/// Another backend, and a function that is called before each of its queries.
[[nodiscard]] std::unique_ptr<TraceBackend> watched(std::unique_ptr<TraceBackend> backend,
                                                    std::function<void()> on_query);

} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/fake_tracers.h"

#include <chrono>
#include <thread>

namespace hone::test {

BuildStats FakeTracer::build(const Scene&, const SceneBuffers*) {
    ++builds;
    return {};
}

BuildStats FakeTracer::update(std::span<const uint>) {
    return {};
}

void FakeTracer::answerSlowly(std::size_t rays) const {
    lengths.push_back(rays);
    if (on_query)
        on_query();
    if (us_per_ray > 0)
        std::this_thread::sleep_for(
            std::chrono::duration<double, std::micro>(us_per_ray * static_cast<double>(rays)));
}

void FakeTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence,
                         const TraceOptions&) const {
    answerSlowly(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = {static_cast<uint>(rays[i].tmin), 7};
}

void FakeTracer::occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence,
                          const TraceOptions&) const {
    answerSlowly(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        occluded[i] = static_cast<uint>(rays[i].tmin) % 2;
}

std::vector<Ray> FakeTracer::rays(std::size_t count) {
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i)
        rays[i] = {vec3(0), static_cast<float>(i), vec3(0, 0, 1), 1e30f};
    return rays;
}

namespace {

class Watched final : public TraceBackend {
public:
    Watched(std::unique_ptr<TraceBackend> backend, std::function<void()> on_query)
        : backend_(std::move(backend)), on_query_(std::move(on_query)) {}
    TraceCaps caps() const override { return backend_->caps(); }
    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        return backend_->build(scene, shared);
    }
    BuildStats update(std::span<const uint> moved) override { return backend_->update(moved); }
    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        on_query_();
        backend_->closest(rays, hits, coherence, options);
    }
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        on_query_();
        backend_->occluded(rays, occluded, coherence, options);
    }

private:
    std::unique_ptr<TraceBackend> backend_;
    std::function<void()> on_query_;
};

} // namespace

std::unique_ptr<TraceBackend> watched(std::unique_ptr<TraceBackend> backend,
                                      std::function<void()> on_query) {
    return std::make_unique<Watched>(std::move(backend), std::move(on_query));
}

} // namespace hone::test

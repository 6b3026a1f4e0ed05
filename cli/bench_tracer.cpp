// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/bench_tracer.h"

#include "hone/cli/bench_clock.h"
#include "hone/core/trace/traceable.h"

#include <algorithm>
#include <iterator>

namespace hone::cli {
namespace {

class RecordingTracer final : public TraceBackend {
public:
    RecordingTracer(std::unique_ptr<TraceBackend> inner, RayRecord& record)
        : inner_(std::move(inner)), record_(&record) {}

    TraceCaps caps() const override { return inner_->caps(); }
    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        return inner_->build(scene, shared);
    }
    BuildStats update(std::span<const uint> moved) override { return inner_->update(moved); }
    std::size_t copiedBytes() const override { return inner_->copiedBytes(); }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        record_->ms += elapsedMs([&] { inner_->closest(rays, hits, coherence, options); });
        if (rays.empty())
            return;
        record_->is_past_mirror = rays.front().origin != record_->eye;
        keep(record_->is_past_mirror ? record_->mirror : record_->primary, rays, coherence);
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        record_->ms += elapsedMs([&] { inner_->occluded(rays, occluded, coherence, options); });
        keep(record_->is_past_mirror ? record_->mirror_shadow : record_->shadow, rays, coherence);
    }

private:
    void keep(RayList& list, std::span<const Ray> rays, Coherence coherence) const {
        if (!record_->keeps_rays)
            return;
        list.coherence = coherence;
        std::ranges::copy_if(rays, std::back_inserter(list.rays), isTraceable);
    }

    std::unique_ptr<TraceBackend> inner_;
    RayRecord* record_;
};

} // namespace

void RayRecord::clear() {
    ms = 0;
    for (RayList* list : lists())
        list->rays.clear();
}

std::unique_ptr<TraceBackend> makeRecordingTracer(std::unique_ptr<TraceBackend> inner,
                                                  RayRecord& record) {
    return std::make_unique<RecordingTracer>(std::move(inner), record);
}

} // namespace hone::cli

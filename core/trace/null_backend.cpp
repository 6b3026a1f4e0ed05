// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/null_backend.h"

#include "hone/core/error.h"

#include <algorithm>

namespace hone {
namespace {

class NullBackend final : public TraceBackend {
public:
    // Never "auto", as the reference never is: a picture without rays is no picture.
    TraceCaps caps() const override {
        return {.name = "null",
                .version = "1",
                .runs_on = "host",
                .always_exact = true,
                .settles_ties = true,
                .updates = true,
                .is_reference = true};
    }
    BuildStats build(const Scene&, const SceneBuffers*) override { return {}; }
    BuildStats update(std::span<const uint>) override { return {}; }
    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence,
                 const TraceOptions&) const override {
        HONE_ASSERT(rays.size() == hits.size(), "one hit a ray");
        std::ranges::fill(hits, Hit{kNone, kNone});
    }
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence,
                  const TraceOptions&) const override {
        HONE_ASSERT(rays.size() == occluded.size(), "one answer a ray");
        std::ranges::fill(occluded, 0u);
    }
};

} // namespace

std::unique_ptr<TraceBackend> makeNullBackend() {
    return std::make_unique<NullBackend>();
}

} // namespace hone

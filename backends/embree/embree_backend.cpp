// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/embree_backend.h"

#include "hone/backends/embree/embree_tree.h"
#include "hone/core/error.h"
#include "hone/core/trace/traceable.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

namespace hone {
namespace {

/// Rays that one task answers at least: whole packets, so that the same rays always meet in one.
constexpr std::size_t kGrain = 64 * kPacket;

/// What idle lanes hold: Embree looks at them, and must find numbers.
constexpr Ray kIdle{vec3(0.0f), 0.0f, vec3(0.0f, 0.0f, 1.0f), 0.0f};

/// Up to 16 consecutive rays of a list, and which lanes are traced.
struct alignas(64) Packet {
    RTCRayHit16 rays;
    std::array<int, kPacket> valid; ///< -1 or 0, as Embree wants it

    Packet(std::span<const Ray> list, std::size_t first) {
        for (uint lane = 0; lane < kPacket; ++lane) {
            const std::size_t index = first + lane;
            const bool traced = index < list.size() && isTraceable(list[index]);
            const Ray& ray = traced ? list[index] : kIdle;
            valid[lane] = traced ? -1 : 0;
            rays.ray.org_x[lane] = ray.origin.x;
            rays.ray.org_y[lane] = ray.origin.y;
            rays.ray.org_z[lane] = ray.origin.z;
            rays.ray.tnear[lane] = std::max(ray.tmin, 0.0f);
            rays.ray.dir_x[lane] = ray.direction.x;
            rays.ray.dir_y[lane] = ray.direction.y;
            rays.ray.dir_z[lane] = ray.direction.z;
            rays.ray.time[lane] = 0.0f;
            rays.ray.tfar[lane] = ray.tmax;
            rays.ray.mask[lane] = ~0u;
            rays.ray.id[lane] = static_cast<uint>(index);
            rays.ray.flags[lane] = 0;
            rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }
};

/// Answers hits[begin, end). Without the coherent flag Embree takes a packet's rays one by one,
/// each as if alone.
void closestOf(const EmbreeTree& tree, std::span<const Ray> rays, std::span<Hit> hits,
               std::size_t begin, std::size_t end, bool coherent) {
    EmbreeQuery query(rays.data(), coherent, EmbreeTree::keepNearest);
    auto& nearest = query.context().nearest;
    for (std::size_t first = begin; first < end; first += kPacket) {
        Packet packet(rays, first);
        nearest.fill({std::numeric_limits<float>::infinity(), {kNone, kNone}});
        for (const EmbreePart& part : tree.parts()) { // nearest, and how far it is, stay
            query.context().part = &part;
            query.intersect(part.scene.handle(), packet.valid.data(), packet.rays);
        }
        const std::size_t count = std::min<std::size_t>(kPacket, end - first);
        for (uint lane = 0; lane < count; ++lane)
            hits[first + lane] = nearest[lane].hit;
    }
}

/// Answers occluded[begin, end) in packets.
void occludedTogether(const EmbreeTree& tree, std::span<const Ray> rays, std::span<uint> occluded,
                      std::size_t begin, std::size_t end) {
    EmbreeQuery query(rays.data(), true, tree.occlusionFilter());
    for (std::size_t first = begin; first < end; first += kPacket) {
        Packet packet(rays, first);
        const std::size_t count = std::min<std::size_t>(kPacket, end - first);
        std::fill_n(&occluded[first], count, 0u);
        for (const EmbreePart& part : tree.parts()) {
            query.context().part = &part;
            query.occluded(part.scene.handle(), packet.valid.data(), packet.rays.ray);
            for (uint lane = 0; lane < count; ++lane)
                if (packet.rays.ray.tfar[lane] < 0.0f) { // Embree sets it to minus infinity
                    occluded[first + lane] = 1;
                    packet.valid[lane] = 0;
                }
        }
    }
}

/// Answers occluded[begin, end) ray by ray: packets of occlusion rays are slower where rays go
/// anywhere, and depend on each other even without the coherent flag.
void occludedOneByOne(const EmbreeTree& tree, std::span<const Ray> rays, std::span<uint> occluded,
                      std::size_t begin, std::size_t end) {
    EmbreeQuery query(rays.data(), false, tree.occlusionFilter());
    for (std::size_t index = begin; index < end; ++index) {
        const Ray& ray = rays[index];
        occluded[index] = 0;
        if (!isTraceable(ray))
            continue;
        RTCRay asked{.org_x = ray.origin.x,
                     .org_y = ray.origin.y,
                     .org_z = ray.origin.z,
                     .tnear = std::max(ray.tmin, 0.0f),
                     .dir_x = ray.direction.x,
                     .dir_y = ray.direction.y,
                     .dir_z = ray.direction.z,
                     .time = 0.0f,
                     .tfar = ray.tmax,
                     .mask = ~0u,
                     .id = static_cast<uint>(index),
                     .flags = 0};
        for (const EmbreePart& part : tree.parts()) {
            query.context().part = &part;
            query.occluded(part.scene.handle(), asked);
            occluded[index] = asked.tfar < 0.0f ? 1u : 0u;
            if (occluded[index] != 0)
                break;
        }
    }
}

/// Runs `answer(begin, end)` over [0, count) on all cores, in whole packets.
template <class Answer> void forEachChunk(std::size_t count, const Answer& answer) {
    const std::size_t chunks = (count + kGrain - 1) / kGrain;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        answer(chunk * kGrain, std::min((chunk + 1) * kGrain, count));
    });
}

class EmbreeBackend final : public TraceBackend {
public:
    explicit EmbreeBackend(const EmbreeParams& params) : params_(params) {}

    TraceCaps caps() const override {
        return {.name = "embree",
                .version = RTC_VERSION_STRING,
                .runs_on = "host",
                .settles_ties = true,
                .updates = true};
    }

    BuildStats build(const Scene& scene, const SceneBuffers*) override {
        const auto begin = Clock::now();
        scene_ = &scene;
        tree_.reset(); // the old tree's memory first
        tree_ = std::make_unique<EmbreeTree>(device_, scene, params_.flatten_triangles);
        return stats(begin);
    }

    BuildStats update(std::span<const uint> moved) override {
        HONE_ASSERT(tree_ != nullptr, "build() comes before the first update");
        const auto begin = Clock::now();
        if (!tree_->move(moved))
            return build(*scene_, nullptr);
        return stats(begin);
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        HONE_ASSERT(rays.size() == hits.size(), "one hit a ray");
        const bool coherent = useCoherentPackets(coherence, options);
        forEachChunk(rays.size(), [&](std::size_t begin, std::size_t end) {
            closestOf(*tree_, rays, hits, begin, end, coherent);
        });
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        HONE_ASSERT(rays.size() == occluded.size(), "one answer a ray");
        const bool coherent = useCoherentPackets(coherence, options);
        forEachChunk(rays.size(), [&](std::size_t begin, std::size_t end) {
            (coherent ? occludedTogether : occludedOneByOne)(*tree_, rays, occluded, begin, end);
        });
    }

private:
    using Clock = std::chrono::steady_clock;

    /// The world's vertices are derived, so nothing of the scene is there twice.
    BuildStats stats(Clock::time_point begin) const {
        return {.ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count(),
                .triangles = tree_->triangles(),
                .bytes = device_.bytes() + tree_->vertexBytes(),
                .copied_bytes = 0};
    }

    bool useCoherentPackets(Coherence coherence, const TraceOptions& options) const {
        HONE_ASSERT(tree_ != nullptr, "build() comes before the first query");
        return coherence == Coherence::kCoherent && !options.exact && tree_->takesCoherentPackets();
    }

    EmbreeParams params_;
    EmbreeDevice device_;
    const Scene* scene_ = nullptr;
    std::unique_ptr<EmbreeTree> tree_;
};

} // namespace

std::unique_ptr<TraceBackend> makeEmbreeBackend() {
    return makeEmbreeBackendWith({});
}

std::unique_ptr<TraceBackend> makeEmbreeBackendWith(const EmbreeParams& params) {
    return std::make_unique<EmbreeBackend>(params);
}

} // namespace hone

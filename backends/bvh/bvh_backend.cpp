// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/bvh/bvh_backend.h"

#include "hone/backends/bvh/bvh_kernels.h"
#include "hone/backends/bvh/bvh_scene.h"
#include "hone/core/error.h"
#include "hone/core/scene/scene_arrays.h"
#include "hone/core/scene/scene_buffers.h"
#include "hone/core/trace/query_memory.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>

namespace hone {
namespace {

/// Rays of one dispatch at most: their buffers can be bound everywhere, and no dispatch runs long.
constexpr std::size_t kMostRays = std::size_t{1} << 19;

class BvhBackend final : public TraceBackend {
public:
    BvhBackend(Device& device, BvhBuilder builder, BvhParams params)
        : device_(&device), builder_(std::move(builder)), params_(std::move(params)),
          query_(device), unfinished_(device.createBuffer(sizeof(uint), "bvh_unfinished")) {}

    TraceCaps caps() const override {
        const DeviceInfo& info = device_->info();
        return {.name = params_.name,
                .version = info.driver.empty() ? "1" : info.driver,
                .runs_on = info.driver.empty() ? "host" : info.name,
                .memory = info.driver.empty() ? TraceMemory::kHost : TraceMemory::kDevice,
                .always_exact = true,
                .settles_ties = true,
                .updates = true};
    }

    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        const auto begin = std::chrono::steady_clock::now();
        tree_.reset();
        own_buffers_.reset();
        scene_ = &scene;
        shared_ = shared;
        tree_.emplace(scene, builder_, params_.flatten_triangles);
        nodes_ = upload(tree_->nodes(), "bvh_nodes");
        skips_ = upload(tree_->skips(), "bvh_skips");
        triangles_ = upload(tree_->triangles(), "bvh_triangles");
        instances_ = upload(tree_->instances(), "bvh_instances");

        // Only holes of masks need the scene itself.
        if (tree_->isMasked() && shared_ == nullptr)
            own_buffers_.emplace(*device_, scene);
        return stats(begin);
    }

    BuildStats update(std::span<const uint> moved) override {
        HONE_ASSERT(tree_.has_value(), "build() comes before update()");
        const auto begin = std::chrono::steady_clock::now();
        if (!tree_->update(moved))
            return build(*scene_, shared_);
        write(tree_->nodes(), nodes_);
        write(tree_->triangles(), triangles_);
        write(tree_->instances(), instances_);
        if (own_buffers_)
            own_buffers_->update(*scene_);
        return stats(begin);
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence,
                 const TraceOptions&) const override {
        HONE_ASSERT(rays.size() == hits.size(), "one hit a ray");
        if (isEmpty())
            std::ranges::fill(hits, Hit{kNone, kNone});
        else
            answer(kBvhClosest, "hits", rays, hits);
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence,
                  const TraceOptions&) const override {
        HONE_ASSERT(rays.size() == occluded.size(), "one answer a ray");
        if (isEmpty())
            std::ranges::fill(occluded, 0u);
        else
            answer(kBvhOccluded, "occluded", rays, occluded);
    }

    std::size_t copiedBytes() const override { return query_.copiedBytes(); }

private:
    [[nodiscard]] bool isEmpty() const {
        HONE_ASSERT(tree_.has_value(), "build() comes before the first query");
        return tree_->worldNodes() == 0;
    }

    template <class T> Buffer upload(std::span<const T> records, const char* name) const {
        const std::size_t most = device_->info().max_binding_bytes;
        if (records.size_bytes() > most)
            throw DeviceError(params_.name + ": " + name + " of " + scene_->name + " take " +
                              std::to_string(records.size_bytes()) + " bytes; " +
                              device_->info().name + " reads at most " + std::to_string(most) +
                              " from one buffer. Trace it with another backend");
        Buffer buffer = device_->createBuffer(std::max(records.size_bytes(), sizeof(T)), name);
        write(records, buffer);
        return buffer;
    }

    template <class T> static void write(std::span<const T> records, const Buffer& buffer) {
        if (!records.empty())
            std::memcpy(buffer.view().data, records.data(), records.size_bytes());
    }

    [[nodiscard]] BuildStats stats(std::chrono::steady_clock::time_point begin) const {
        const std::chrono::duration<double, std::milli> passed =
            std::chrono::steady_clock::now() - begin;
        std::size_t copied = 0;
        if (own_buffers_)
            for (const MemoryCopy& copy : own_buffers_->copies())
                copied += copy.bytes;
        return {.ms = passed.count(),
                .triangles = tree_->triangleCount(),
                .bytes = nodes_.bytes() + skips_.bytes() + triangles_.bytes() + instances_.bytes(),
                .copied_bytes = copied};
    }

    [[nodiscard]] Arguments arguments() const {
        Arguments result;
        if (tree_->isMasked())
            result.bind((own_buffers_ ? &*own_buffers_ : shared_)->arguments());
        else
            forEachSceneArray(*scene_, [&](std::string_view name, auto) { result.bind(name, {}); });
        result.bind("bvh_nodes", nodes_.view());
        result.bind("bvh_skips", skips_.view());
        result.bind("bvh_triangles", triangles_.view());
        result.bind("bvh_instances", instances_.view());
        result.bind("bvh_unfinished", unfinished_.view());
        return result;
    }

    /// Runs `kernel`, whose answers go to `port`.
    template <class Answer>
    void answer(const Kernel& kernel, const char* port, std::span<const Ray> rays,
                std::span<Answer> answers) const {
        if (rays.empty())
            return;
        query_.bind(rays, std::as_writable_bytes(answers));
        const std::size_t most = std::min(rays.size(), kMostRays);
        if (states_.bytes() < most * sizeof(BvhState))
            states_ = device_->createBuffer(most * sizeof(BvhState), "bvh_states");
        Arguments bound = arguments();
        bound.bind("bvh_states", states_.view());

        for (std::size_t first = 0; first < rays.size(); first += kMostRays) {
            const auto count = static_cast<uint>(std::min(kMostRays, rays.size() - first));
            const uint first_ray = bindStretch<Ray>(bound, "rays", query_.rays(), first, count);
            const uint first_answer =
                bindStretch<Answer>(bound, port, query_.answers(), first, count);
            BvhQueryParams params{.first_ray = first_ray,
                                  .first_answer = first_answer,
                                  .node_count = static_cast<uint>(tree_->nodes().size()),
                                  .step_limit = params_.step_limit,
                                  .is_resumed = 0,
                                  .extent = tree_->extent()};
            uint& unfinished = unfinished_.as<uint>()[0];
            do {
                unfinished = 0;
                CommandEncoder& encoder = device_->encoder();
                encoder.dispatch(kernel, bound, std::as_bytes(std::span(&params, 1)), count);
                encoder.finish();
                params.is_resumed = 1;
            } while (unfinished != 0);
        }
        query_.collect();
    }

    Device* device_;
    BvhBuilder builder_;
    BvhParams params_;
    const Scene* scene_ = nullptr;
    const SceneBuffers* shared_ = nullptr;
    std::optional<BvhScene> tree_;
    std::optional<SceneBuffers> own_buffers_;
    Buffer nodes_, skips_, triangles_, instances_;
    // One query at a time.
    mutable QueryMemory query_;
    mutable Buffer states_;
    Buffer unfinished_;
};

} // namespace

std::unique_ptr<TraceBackend> makeBvhTracer(Device& device, BvhBuilder builder,
                                            const BvhParams& params) {
    return std::make_unique<BvhBackend>(device, std::move(builder), params);
}

} // namespace hone

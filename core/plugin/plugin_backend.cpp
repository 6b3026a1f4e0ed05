// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_backend.h"

#include "hone/core/log.h"
#include "hone/core/plugin/plugin_host.h"

#include <chrono>

namespace hone {
namespace {

std::uint32_t queryFlags(Coherence coherence, const TraceOptions& options) {
    return (coherence == Coherence::kCoherent ? HONE_QUERY_COHERENT : 0u) |
           (options.exact ? HONE_QUERY_EXACT : 0u);
}

class PluginBackend final : public TraceBackend {
public:
    PluginBackend(std::shared_ptr<const PluginLibrary> library, std::size_t index)
        : library_(std::move(library)), info_(library_->info.trace_backends[index]),
          table_(library_->trace_backends[index]), host_(makeHost(*library_)) {
        call("create", [&](hone_error* error) { return table_.create(&host_, &tracer_, error); });
        if (tracer_ == nullptr)
            fail("create said that all is well, but made nothing");
    }

    ~PluginBackend() override {
        try {
            table_.destroy(tracer_);
        } catch (...) {
            logger().warn("{}: destroy threw an exception", who());
        }
    }

    PluginBackend(const PluginBackend&) = delete;
    PluginBackend& operator=(const PluginBackend&) = delete;

    TraceCaps caps() const override {
        const auto says = [&](std::uint32_t flag) { return (table_.flags & flag) != 0; };
        return {.name = info_.name,
                .version = info_.version,
                .runs_on = info_.runs_on,
                .masked = !says(HONE_TRACE_NO_MASKS),
                .always_exact = says(HONE_TRACE_ALWAYS_EXACT),
                .settles_ties = says(HONE_TRACE_SETTLES_TIES),
                .updates = says(HONE_TRACE_UPDATES) && table_.update != nullptr,
                .is_reference = says(HONE_TRACE_REFERENCE)};
    }

    BuildStats build(const Scene& scene, const SceneBuffers*) override {
        // The plug-in may look at the old scene until it has taken the new one.
        auto access = std::make_unique<SceneAccess>(scene);
        auto seen = std::make_unique<hone_scene>(makeScene(scene, *access));
        is_built_ = false;
        const BuildStats stats =
            timed("build", scene, [&](hone_build_stats* made, hone_error* error) {
                return table_.build(tracer_, seen.get(), made, error);
            });
        access_ = std::move(access);
        seen_ = std::move(seen);
        is_built_ = true;
        return stats;
    }

    BuildStats update(std::span<const uint> moved) override {
        HONE_ASSERT(is_built_, info_.name + " is not built");
        if (table_.update == nullptr)
            return build(*access_->scene, nullptr);
        is_built_ = false;
        const BuildStats stats =
            timed("update", *access_->scene, [&](hone_build_stats* made, hone_error* error) {
                return table_.update(tracer_, seen_.get(), moved.data(), moved.size(), made, error);
            });
        is_built_ = true;
        return stats;
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        HONE_ASSERT(rays.size() == hits.size(), "one hit a ray");
        HONE_ASSERT(is_built_, info_.name + " is not built");
        if (rays.empty())
            return;
        call("closest", [&](hone_error* error) {
            return table_.closest(tracer_, reinterpret_cast<const hone_ray*>(rays.data()),
                                  reinterpret_cast<hone_hit*>(hits.data()), rays.size(),
                                  queryFlags(coherence, options), error);
        });
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (!isInScene(*access_->scene, hits[i]))
                fail("closest answered ray " + std::to_string(i) + " with instance " +
                     std::to_string(hits[i].instance) + ", primitive " +
                     std::to_string(hits[i].primitive) + ", which the scene does not have");
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        HONE_ASSERT(rays.size() == occluded.size(), "one answer a ray");
        HONE_ASSERT(is_built_, info_.name + " is not built");
        if (rays.empty())
            return;
        call("occluded", [&](hone_error* error) {
            return table_.occluded(tracer_, reinterpret_cast<const hone_ray*>(rays.data()),
                                   occluded.data(), rays.size(), queryFlags(coherence, options),
                                   error);
        });
        for (std::size_t i = 0; i < occluded.size(); ++i)
            if (occluded[i] > 1)
                fail("occluded answered ray " + std::to_string(i) + " with " +
                     std::to_string(occluded[i]) + ", not 1 or 0");
    }

private:
    std::string who() const {
        return "plug-in " + printable(library_->info.file) + ": trace backend \"" + info_.name +
               "\"";
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw PluginError(who() + ": " + what);
    }

    template <class Function> void call(const char* name, const Function& function) const {
        callPlugin([this] { return who(); }, name, function);
    }

    template <class Function>
    BuildStats timed(const char* name, const Scene& scene, const Function& function) {
        hone_build_stats made{};
        made.struct_size = sizeof made;
        made.triangles = scene.instancedTriangles();
        const auto begin = std::chrono::steady_clock::now();
        call(name, [&](hone_error* error) { return function(&made, error); });
        const std::chrono::duration<double, std::milli> passed =
            std::chrono::steady_clock::now() - begin;
        return {.ms = passed.count(),
                .triangles = made.triangles,
                .bytes = made.bytes,
                .copied_bytes = made.copied_bytes};
    }

    std::shared_ptr<const PluginLibrary> library_; // first: the code goes last
    const PluginInfo::Backend& info_;
    const hone_trace_backend& table_;
    const hone_host host_;
    hone_tracer* tracer_ = nullptr;
    std::unique_ptr<SceneAccess> access_; // on the heap: plug-ins keep pointers to them
    std::unique_ptr<hone_scene> seen_;
    bool is_built_ = false;
};

} // namespace

std::unique_ptr<TraceBackend> makePluginBackend(std::shared_ptr<const PluginLibrary> library,
                                                std::size_t index) {
    return std::make_unique<PluginBackend>(std::move(library), index);
}

} // namespace hone

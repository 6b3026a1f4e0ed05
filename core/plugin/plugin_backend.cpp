// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_backend.h"

#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/core/plugin/same_records.h"
#include "hone/core/printable.h"
#include "hone/core/scene/host_surface.h"

#include <chrono>
#include <exception>
#include <optional>

namespace hone {
namespace {

/// What hone_scene::hone points to.
struct SceneAccess {
    explicit SceneAccess(const Scene& the_scene) : scene(&the_scene), surface(the_scene) {}
    const Scene* scene;
    HostSurface surface;
};

const SceneAccess& accessOf(const hone_scene* scene) {
    return *static_cast<const SceneAccess*>(scene->hone);
}

// ---- hone_host's functions. Plug-ins are C: nothing may leave these but by return. ----

void hostLog(const hone_host*, std::int32_t level, const char* text) noexcept {
    const std::string shown = printable(text != nullptr ? text : "");
    if (level >= HONE_LOG_WARN)
        logger().warn("{}", shown);
    else if (level == HONE_LOG_INFO)
        logger().info("{}", shown);
    else
        logger().debug("{}", shown);
}

std::int32_t hostIsSolid(const hone_scene* scene, const hone_ray* ray, hone_hit hit) noexcept {
    return accessOf(scene).surface.isSolid(reinterpret_cast<const Ray&>(*ray),
                                           {hit.instance, hit.primitive})
               ? 1
               : 0;
}

void hostWorldPosition(const hone_scene* scene, std::uint32_t instance, std::uint32_t vertex,
                       float position[3]) noexcept {
    const SceneAccess& access = accessOf(scene);
    const vec3 placed = access.surface.worldPosition(access.scene->instances[instance], vertex);
    for (int axis = 0; axis < 3; ++axis)
        position[axis] = placed[axis];
}

void hostParallelFor(const hone_host* host, std::size_t count, std::size_t grain,
                     void (*body)(void*, std::size_t, std::size_t), void* context) noexcept {
    static_cast<const PluginLibrary*>(host->hone)->parallel_for(count, grain, body, context);
}

hone_host makeHost(const PluginLibrary& library) {
    return {.struct_size = sizeof(hone_host),
            .abi_major = HONE_PLUGIN_ABI_MAJOR,
            .abi_minor = HONE_PLUGIN_ABI_MINOR,
            .reserved = 0,
            .hone = const_cast<PluginLibrary*>(&library), // only read, by hostParallelFor
            .log = hostLog,
            .is_solid = hostIsSolid,
            .world_position = hostWorldPosition,
            .parallel_for = hostParallelFor};
}

/// The scene's own arrays, seen through the border's types (same_records.h).
hone_scene makeScene(const Scene& scene, const SceneAccess& access) {
    return {.struct_size = sizeof(hone_scene),
            .reserved = 0,
            .hone = &access,
            .positions = reinterpret_cast<const float(*)[3]>(scene.positions.data()),
            .normals = reinterpret_cast<const float(*)[3]>(scene.normals.data()),
            .uvs = reinterpret_cast<const float(*)[2]>(scene.uvs.data()),
            .position_count = scene.positions.size(),
            .triangles = reinterpret_cast<const std::uint32_t(*)[3]>(scene.triangles.data()),
            .triangle_count = scene.triangles.size(),
            .meshes = reinterpret_cast<const hone_mesh*>(scene.meshes.data()),
            .mesh_count = scene.meshes.size(),
            .instances = reinterpret_cast<const hone_instance*>(scene.instances.data()),
            .instance_count = scene.instances.size(),
            .materials = reinterpret_cast<const hone_material*>(scene.materials.data()),
            .material_count = scene.materials.size(),
            .textures = reinterpret_cast<const hone_texture*>(scene.textures.data()),
            .texture_count = scene.textures.size(),
            .texels = scene.texels.data(),
            .texel_count = scene.texels.size()};
}

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
            if (!isInScene(hits[i]))
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

    /// Calls into the plug-in and turns what it ends with into an exception.
    template <class Function> void call(const std::string& name, Function&& function) const {
        hone_error error{};
        hone_status status = HONE_OK;
        try {
            status = function(&error);
        } catch (const std::exception& problem) {
            fail(name + " threw an exception: " + printable(problem.what()));
        } catch (...) {
            fail(name + " threw something that is no std::exception");
        }
        if (status == HONE_OK)
            return;
        error.text[sizeof error.text - 1] = '\0';
        const std::string reason =
            error.text[0] != '\0' ? printable(error.text) : "it gave no reason";
        const std::string text = who() + ": " + name + " failed: " + reason;
        if (status == HONE_NO_DEVICE)
            throw DeviceError(text);
        if (status == HONE_OUT_OF_MEMORY)
            throw OutOfMemory(text);
        throw PluginError(text);
    }

    template <class Function>
    BuildStats timed(const std::string& name, const Scene& scene, Function&& function) {
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

    bool isInScene(Hit hit) const {
        if (hit.instance == kNone)
            return hit.primitive == kNone;
        const Scene& scene = *access_->scene;
        return hit.instance < scene.instances.size() &&
               hit.primitive < scene.meshes[scene.instances[hit.instance].mesh].triangle_count;
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

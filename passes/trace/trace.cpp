// SPDX-License-Identifier: Apache-2.0
//
// trace: answers requests with ray-traced radiance samples.
//
// A pixel's samples go through its centre: they share the primary ray, and so its hit, and differ
// in the points of area lights that their shadow rays go to. A hit is shaded with the functions
// that raster uses, in the same order of sums (shading.glsl.h), each light times whether its shadow
// ray arrives; mirrors are followed. Sample s of pixel p depends on the scene, the camera, the
// seed, p and s only.
//
// in   requests  RequestList
// in   scene     Scene
// in   camera    Camera
// out  samples   Samples: for each request its samples, ascending
// params  backend    who answers the rays
//         samples    most samples that a request asks for; not less than that of request (1)
//         max_depth  reflections that are followed (3)
//         terminal   what a mirror shows past the last one; sky: the environment, black: nothing
//         exact      each ray is answered as if it were alone, whatever else is in the list (false)
// counters  rays.primary, rays.shadow, rays.reflection
//
//     "trace": { "type": "trace", "in": { "requests": "request.requests", "scene": "$scene",
//                "camera": "$camera" }, "params": { "backend": "$backend", "samples": "$samples" }
//                }
//
// Source: Whitted, An Improved Illumination Model for Shaded Display, 1980; Amann, Chajdas,
// Westermann 2012, section 4 (shadow and reflection rays, depth 3).
#include "hone/core/error.h"
#include "hone/passes/passes.h"

#include "hone_spirv/trace_resolve.h"
#include "hone_spirv/trace_shade.h"
#include "hone_spirv/trace_start.h"

#include "hone/core/device/kernel.glsl.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace hone {
namespace {

struct Start : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/trace/trace_start.glsl.h"
};
constexpr Kernel kStart = makeKernel<Start>("trace_start", spirv::trace_start);

struct Shade : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/trace/trace_shade.glsl.h"
};
constexpr Kernel kShade = makeKernel<Shade>("trace_shade", spirv::trace_shade);

struct Resolve : HostKernel {
    using HostKernel::HostKernel;
#include "hone/passes/trace/trace_resolve.glsl.h"
};
constexpr Kernel kResolve = makeKernel<Resolve>("trace_resolve", spirv::trace_resolve);

using Path = Shade::Path;

/// Device memory that is kept between calls and only grows.
class Scratch {
public:
    explicit Scratch(std::string_view name) : name_(name) {}
    template <class T> void reserve(Device& device, std::size_t count) {
        if (buffer_.bytes() < count * sizeof(T))
            buffer_ = device.createBuffer(count * sizeof(T), name_);
    }
    template <class T> [[nodiscard]] std::span<T> as() const { return buffer_.as<T>(); }
    [[nodiscard]] Argument argument() const { return {name_, buffer_.view()}; }

private:
    std::string_view name_;
    Buffer buffer_;
};

/// Requests that are traced together, few enough for their rays to stay in the caches.
struct Wave {
    std::size_t first_request = 0, requests = 0;
    std::size_t first_slot = 0, paths = 0;
};

class TracePass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        const std::span<const uvec3> requests = context.in("requests").as<uvec3>();
        Value& out = context.out("samples");
        light_count_ = static_cast<uint>(scene.lights.size());
        options_.exact = context.param<bool>("exact");
        max_depth_ = context.param<uint>("max_depth");
        ends_in_sky_ = context.params->choice("terminal") == 0;

        std::size_t samples = 0;
        for (const uvec3& request : requests)
            samples += request.z;
        const std::size_t room = out.capacity<Sample>().size();
        if (samples > room)
            throw GraphError(std::string(context.pass_name) + ": " + std::to_string(samples) +
                             " samples are requested, but there is room for " +
                             std::to_string(room) +
                             "; set this pass's parameter \"samples\" to that of request");
        out.count = static_cast<uint>(samples);
        if (samples == 0)
            return;

        const TraceBackend& backend =
            context.tracers->get(context.param<std::string>("backend"), context.scene());
        for (Wave wave; wave.first_request < requests.size();
             wave.first_request += wave.requests, wave.first_slot += wave.paths) {
            findEnd(wave, requests, *context.memory);
            trace(context, wave, backend);
        }
    }

private:
    /// Paths of a wave: large enough for threads to share, small enough for the caches; several
    /// lights make a path larger.
    [[nodiscard]] std::size_t wavePaths() const {
        constexpr std::size_t kPaths = 32768;
        return std::max<std::size_t>(kPaths / std::max(light_count_, 1u), 4096);
    }

    /// Takes as many requests as fit, at least one, and makes room for them.
    void findEnd(Wave& wave, std::span<const uvec3> requests, Device& device) {
        const std::size_t limit = wavePaths();
        const std::span<const uvec3> rest = requests.subspan(wave.first_request);
        first_paths_.reserve<uint>(device, limit);
        const std::span<uint> first_paths = first_paths_.as<uint>();
        wave.requests = 0;
        wave.paths = 0;
        while (wave.requests < std::min(rest.size(), limit)) {
            const std::size_t next = wave.paths + rest[wave.requests].z;
            if (next > limit && wave.requests > 0)
                break;
            first_paths[wave.requests++] = static_cast<uint>(wave.paths);
            wave.paths = next;
        }

        const std::size_t paths = std::max(wave.requests, wave.paths);
        for (Scratch* rays : {&rays_, &next_rays_})
            rays->reserve<Ray>(device, paths);
        for (Scratch* states : {&paths_, &next_paths_})
            states->reserve<Path>(device, paths);
        hits_.reserve<Hit>(device, paths);
        next_flags_.reserve<uint>(device, paths);
        shadow_rays_.reserve<Ray>(device, paths * light_count_);
        light_radiance_.reserve<vec3>(device, paths * light_count_);
        occluded_.reserve<uint>(device, paths * light_count_);
    }

    void trace(PassContext& context, const Wave& wave, const TraceBackend& backend) {
        // Primary rays, one a request.
        const Start::Params start{.camera = context.camera(),
                                  .extent = context.extent,
                                  .first_request = static_cast<uint>(wave.first_request),
                                  .first_slot = static_cast<uint>(wave.first_slot)};
        const std::array start_arguments{first_paths_.argument(), rays_.argument(),
                                         paths_.argument()};
        context.dispatch(kStart, start, static_cast<uint>(wave.requests), start_arguments);
        context.chosen->finish();
        backend.closest(rays_.as<Ray>().first(wave.requests), hits_.as<Hit>().first(wave.requests),
                        Coherence::kCoherent, options_);
        context.counters->add("rays.primary", wave.requests);

        // Bounce after bounce; one past the last sees the environment only.
        std::size_t paths = wave.paths;
        for (uint bounce = 0; paths > 0; ++bounce) {
            if (bounce > 0 && bounce <= max_depth_) {
                backend.closest(rays_.as<Ray>().first(paths), hits_.as<Hit>().first(paths),
                                Coherence::kIncoherent, options_);
                context.counters->add("rays.reflection", paths);
            } else if (bounce > max_depth_) {
                std::ranges::fill(hits_.as<Hit>().first(paths), Hit{kNone, kNone});
            }
            shade(context, bounce, static_cast<uint>(paths), backend);
            const Survivors survivors = keepSurvivors(paths);
            context.counters->add("rays.shadow", survivors.shadow_rays);
            paths = survivors.paths;
        }
    }

    void shade(PassContext& context, uint bounce, uint paths, const TraceBackend& backend) {
        const bool is_last = bounce > max_depth_;
        const Shade::Params params{.path_count = paths,
                                   .light_count = is_last ? 0 : light_count_,
                                   .bounce = bounce,
                                   .reflects = bounce + (ends_in_sky_ ? 0 : 1) <= max_depth_,
                                   .tan_half_fov_y = context.camera().tan_half_fov_y,
                                   .height = context.extent.y,
                                   .seed_low = static_cast<uint>(context.seed),
                                   .seed_high = static_cast<uint>(context.seed >> 32)};
        const std::array arguments{paths_.argument(),      rays_.argument(),
                                   hits_.argument(),       shadow_rays_.argument(),
                                   next_rays_.argument(),  light_radiance_.argument(),
                                   next_paths_.argument(), next_flags_.argument()};
        context.dispatch(kShade, params, paths, arguments);
        context.chosen->finish();
        if (params.light_count == 0)
            return;

        // Shadow rays to one light start and end together.
        for (std::size_t light = 0; light < light_count_; ++light)
            backend.occluded(shadow_rays_.as<Ray>().subspan(light * paths, paths),
                             occluded_.as<uint>().subspan(light * paths, paths),
                             bounce == 0 ? Coherence::kCoherent : Coherence::kIncoherent, options_);
        const std::array resolve_arguments{paths_.argument(), occluded_.argument(),
                                           light_radiance_.argument()};
        context.dispatch(kResolve, Resolve::Params{paths, light_count_}, paths, resolve_arguments);
        context.chosen->finish();
    }

    struct Survivors {
        std::size_t paths = 0, shadow_rays = 0;
    };

    /// Moves the paths that go on together, in their order: counts by block, then copies.
    Survivors keepSurvivors(std::size_t paths) {
        constexpr std::size_t kBlock = 4096;
        const std::span<const uint> flags = next_flags_.as<uint>();
        const std::span<const Path> next_paths = next_paths_.as<Path>();
        const std::span<const Ray> next_rays = next_rays_.as<Ray>();
        const std::span<Path> kept_paths = paths_.as<Path>();
        const std::span<Ray> kept_rays = rays_.as<Ray>();
        blocks_.resize((paths + kBlock - 1) / kBlock);
        const auto end = [&](std::size_t block) { return std::min(paths, (block + 1) * kBlock); };

        tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t block) {
            Survivors here;
            for (std::size_t i = block * kBlock; i < end(block); ++i) {
                here.paths += flags[i] >> 31;
                here.shadow_rays += flags[i] & ~Shade::kGoesOn;
            }
            blocks_[block] = here;
        });
        Survivors all;
        for (Survivors& block : blocks_) {
            all.shadow_rays += block.shadow_rays;
            all.paths += std::exchange(block.paths, all.paths);
        }
        if (all.paths == 0)
            return all;
        tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t block) {
            std::size_t kept = blocks_[block].paths;
            for (std::size_t i = block * kBlock; i < end(block); ++i) {
                if ((flags[i] & Shade::kGoesOn) == 0)
                    continue;
                kept_rays[kept] = next_rays[i];
                kept_paths[kept] = next_paths[i];
                kept_paths[kept].ray = static_cast<uint>(kept);
                ++kept;
            }
        });
        return all;
    }

    TraceOptions options_;
    uint light_count_ = 0;
    uint max_depth_ = 0;
    bool ends_in_sky_ = true;
    Scratch first_paths_{"first_paths"}, rays_{"rays"}, paths_{"paths"}, hits_{"hits"};
    Scratch shadow_rays_{"shadow_rays"}, light_radiance_{"light_radiance"}, occluded_{"occluded"};
    Scratch next_rays_{"next_rays"}, next_paths_{"next_paths"}, next_flags_{"next_flags"};
    std::vector<Survivors> blocks_;
};

} // namespace

PassType tracePass() {
    return PassType("trace", "Answers requests with ray-traced radiance samples")
        .in("requests", types::kRequestList, "pixels and samples to trace")
        .in("scene", types::kScene, "what is seen")
        .in("camera", types::kCamera, "where from")
        .out("samples", types::kSamples, "for each request its samples, ascending",
             [](const SizeQuery& query) {
                 return query.input("requests") * query.params.get<uint>("samples");
             })
        .backendParam("backend", "who answers the rays")
        .param("samples", 1u, {.min = 1, .max = {}},
               "most samples that a request asks for; not less than that of request")
        .param("max_depth", 3u, {.min = 0, .max = 64}, "reflections that are followed")
        .param("terminal", {"sky", "black"},
               "what a mirror shows past the last reflection: the environment or nothing")
        .param("exact", false, "each ray is answered as if it were alone, at the price of speed")
        .implementedBy<TracePass>(Domain::kEither);
}

} // namespace hone

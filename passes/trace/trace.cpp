// SPDX-License-Identifier: Apache-2.0
//
// trace: answers requests with ray-traced radiance samples.
//
// A pixel's samples go through its centre. A pinhole's share the primary ray, and so its hit, and
// differ in the points of lights with an extent that their shadow rays go to; a thin lens's start
// at points of the lens and meet where the ray through its centre crosses the plane of focus. A hit
// is shaded with the functions that raster uses, in the same order of sums (shading.glsl.h), each
// light times whether its shadow ray arrives; mirrors are followed. Sample s of pixel p depends on
// the scene, the camera, the seed, p and s only.
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
// Rays are asked for in slices; when the run is cancelled or out of time between two of them, it
// goes on there in the next run.
//
//     "trace": { "type": "trace", "in": { "requests": "request.requests", "scene": "$scene",
//                "camera": "$camera" }, "params": { "backend": "$backend", "samples": "$samples" }
//                }
//
// Source: Whitted, An Improved Illumination Model for Shaded Display, 1980; Cook, Porter,
// Carpenter, Distributed Ray Tracing, 1984 (the lens); Amann, Chajdas, Westermann 2012, section 4
// (shadow and reflection rays, depth 3).
#include "hone/core/error.h"
#include "hone/core/trace/trace_slices.h"
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
        if (!context.goes_on)
            at_ = {};
        if (samples == 0)
            return;

        const TraceBackend& backend =
            context.tracers->get(context.param<std::string>("backend"), context.scene());
        while (true) {
            takeStep(context, requests, backend);
            if (at_.wave.first_request == requests.size())
                return;
            if (context.interrupt.isDue())
                throw Interrupted{};
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

    void takeStep(PassContext& context, std::span<const uvec3> requests,
                  const TraceBackend& backend) {
        switch (at_.step) {
        case Step::kStart:
            findEnd(at_.wave, requests, *context.memory);
            start(context, at_.wave);
            at_.bounce = 0;
            at_.paths = at_.wave.paths;
            at_.step = Step::kClosest;
            break;
        case Step::kClosest:
            findHits(context, backend);
            at_.step = at_.paths > 0 ? Step::kShade : Step::kKeep;
            break;
        case Step::kShade:
            shade(context);
            at_.light = 0;
            at_.step = Step::kOccluded;
            break;
        case Step::kOccluded:
            findShadows(context, backend);
            at_.step = Step::kKeep;
            break;
        case Step::kKeep:
            at_.paths = keepSurvivors(*context.counters, at_.paths);
            ++at_.bounce;
            at_.step = Step::kClosest;
            if (at_.paths == 0) {
                at_.wave.first_request += at_.wave.requests;
                at_.wave.first_slot += at_.wave.paths;
                at_.step = Step::kStart;
            }
            break;
        }
    }

    void start(PassContext& context, const Wave& wave) {
        const Start::Params params{.camera = context.camera(),
                                   .extent = context.extent,
                                   .first_request = static_cast<uint>(wave.first_request),
                                   .first_slot = static_cast<uint>(wave.first_slot),
                                   .seed_low = static_cast<uint>(context.seed),
                                   .seed_high = static_cast<uint>(context.seed >> 32)};
        const std::array arguments{first_paths_.argument(), rays_.argument(), paths_.argument()};
        context.dispatch(kStart, params, static_cast<uint>(wave.requests), arguments);
        context.chosen->finish();
    }

    /// Asks for what is left of a query and counts it; throws Interrupted if it gave up with rays
    /// left, so that the next execution asks for those.
    template <class Answer>
    void ask(PassContext& context, const TraceBackend& backend, TraceQuery<Answer> query,
             std::string_view counter) {
        const std::size_t before = std::exchange(at_.answered, 0);
        query.answered = before;
        query.options = options_;
        const bool is_done = slices_.answer(backend, query, context.interrupt);
        if (!counter.empty())
            context.counters->add(counter, query.answered - before);
        if (is_done)
            return;
        at_.answered = query.answered;
        throw Interrupted{};
    }

    /// What primary rays (a pinhole's: one a request) and reflected ones (one a path) hit; one
    /// bounce past the last sees the environment only.
    void findHits(PassContext& context, const TraceBackend& backend) {
        const bool is_primary = at_.bounce == 0;
        const bool is_shared = is_primary && context.camera().lens_radius == 0.0f;
        const std::size_t rays = is_shared ? at_.wave.requests : at_.paths;
        const std::span<Hit> hits = hits_.as<Hit>().first(rays);
        if (at_.bounce > max_depth_) {
            std::ranges::fill(hits, Hit{kNone, kNone});
            return;
        }
        ask(context, backend,
            ClosestQuery{.rays = rays_.as<Ray>().first(rays),
                         .answers = hits,
                         .coherence = is_primary ? Coherence::kCoherent : Coherence::kIncoherent},
            is_primary ? "rays.primary" : "rays.reflection");
    }

    void shade(PassContext& context) {
        const Shade::Params params{.path_count = static_cast<uint>(at_.paths),
                                   .light_count = lights(),
                                   .bounce = at_.bounce,
                                   .reflects = at_.bounce + (ends_in_sky_ ? 0 : 1) <= max_depth_,
                                   .tan_half_fov_y = context.camera().tan_half_fov_y,
                                   .height = context.extent.y,
                                   .seed_low = static_cast<uint>(context.seed),
                                   .seed_high = static_cast<uint>(context.seed >> 32)};
        const std::array arguments{paths_.argument(),      rays_.argument(),
                                   hits_.argument(),       shadow_rays_.argument(),
                                   next_rays_.argument(),  light_radiance_.argument(),
                                   next_paths_.argument(), next_flags_.argument()};
        context.dispatch(kShade, params, params.path_count, arguments);
        context.chosen->finish();
    }

    /// Shadow rays to one light start and end together.
    void findShadows(PassContext& context, const TraceBackend& backend) {
        if (lights() == 0)
            return;
        while (at_.light < light_count_) {
            ask(context, backend,
                OccludedQuery{
                    .rays = shadow_rays_.as<Ray>().subspan(at_.light * at_.paths, at_.paths),
                    .answers = occluded_.as<uint>().subspan(at_.light * at_.paths, at_.paths),
                    .coherence = at_.bounce == 0 ? Coherence::kCoherent : Coherence::kIncoherent},
                ""); // those of paths that see the light are counted, when that is known
            if (++at_.light < light_count_ && context.interrupt.isDue())
                throw Interrupted{};
        }
        const std::array arguments{paths_.argument(), occluded_.argument(),
                                   light_radiance_.argument()};
        const uint paths = static_cast<uint>(at_.paths);
        context.dispatch(kResolve, Resolve::Params{paths, light_count_}, paths, arguments);
        context.chosen->finish();
    }

    /// Lights that hits of this bounce see.
    [[nodiscard]] uint lights() const { return at_.bounce > max_depth_ ? 0 : light_count_; }

    struct Survivors {
        std::size_t paths = 0, shadow_rays = 0;
    };

    /// Moves the paths that go on together, in their order: counts by block, then copies. Returns
    /// how many they are; counts the shadow rays.
    std::size_t keepSurvivors(Counters& counters, std::size_t paths) {
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
        counters.add("rays.shadow", all.shadow_rays);
        if (all.paths == 0)
            return 0;
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
        return all.paths;
    }

    /// What a wave does next: each step leaves all that the others need, so that an execution that
    /// gave up goes on where it was.
    enum class Step : std::uint8_t { kStart, kClosest, kShade, kOccluded, kKeep };
    struct Position {
        Wave wave;
        Step step = Step::kStart;
        uint bounce = 0;
        std::size_t paths = 0;    ///< of this bounce
        std::size_t light = 0;    ///< whose shadow rays are asked for
        std::size_t answered = 0; ///< rays of the query that is asked for
    };

    Position at_;
    TraceSlices slices_;
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

// SPDX-License-Identifier: Apache-2.0
//
// Write a trace backend for hone in C++20: one class, one line. Header only, on top of
// hone_plugin.h, which says what a tracer must answer.
//
//     class Mine {
//     public:
//         explicit Mine(hone::plugin::Host host);      // may keep the host
//         void build(const hone_scene& scene);         // may keep the scene
//         hone_hit closest(const hone_ray& ray) const; // hone::plugin::kMiss for nothing
//         bool occluded(const hone_ray& ray) const;
//     };
//     HONE_TRACE_PLUGIN(Mine, {.name = "mine", .version = "1.0", .license = "MIT", .doc =
//     "Traces."})
//
// - closest and occluded are asked ray by ray, from many threads at once, and only for rays that
//   can hit something. A tracer that likes lists better (a GPU's) has, instead of these two,
//         void closest(std::span<const hone_ray>, std::span<hone_hit>, uint32_t flags);
//         void occluded(std::span<const hone_ray>, std::span<uint32_t>, uint32_t flags);
//   called from one thread at a time, which must expect all rays.
// - build may take a hone_build_stats& more and say what it made.
// - A tracer that can follow moved instances without a build has
//         void update(const hone_scene& scene, std::span<const uint32_t> moved);
// - Any of these may throw: what() becomes the reason that hone reports.
#ifndef HONE_PLUGIN_HPP
#define HONE_PLUGIN_HPP

// Not rooted: plug-ins have these headers alone.
#include "hone_plugin.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>

// Hidden: what two plug-ins make of these templates must not be merged.
#pragma GCC visibility push(hidden)

namespace hone::plugin {

inline constexpr hone_hit kMiss{HONE_NONE, HONE_NONE};

/// Throw it where what a tracer runs on is not there: hone ends with "no device", not with a
/// failed plug-in.
struct NoDevice : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What a plug-in says of itself.
struct About {
    const char* name; ///< a-z, 0-9, _ and ., a letter first; graphs call its trace backend so, too
    const char* version;
    const char* license;           ///< SPDX expression
    const char* doc;               ///< one sentence
    std::uint32_t flags = 0;       ///< of a trace backend: HONE_TRACE_...
    const char* runs_on = nullptr; ///< its device's name; null = the host
};

/// What hone does for a tracer; a value, copied freely. From any thread.
class Host {
public:
    explicit Host(const hone_host& host) : host_(&host) {}

    /// Whether the point that `ray` sees on the triangle `hit` is solid, no hole of a mask.
    [[nodiscard]] bool isSolid(const hone_scene& scene, const hone_ray& ray, hone_hit hit) const {
        return host_->is_solid(&scene, &ray, hit) != 0;
    }
    /// Where `vertex` (a number in hone_scene::positions) of an instance is, in world space.
    [[nodiscard]] std::array<float, 3>
    worldPosition(const hone_scene& scene, std::uint32_t instance, std::uint32_t vertex) const {
        std::array<float, 3> position;
        host_->world_position(&scene, instance, vertex, position.data());
        return position;
    }
    /// Says something to the person in front of hone; `level` is HONE_LOG_...
    void log(std::int32_t level, const std::string& text) const {
        host_->log(host_, level, text.c_str());
    }
    /// Calls body(begin, end) for ranges of at most `grain` that cover [0, count) once, on
    /// hone's threads; throws what a body threw first.
    template <class Body>
    void parallelFor(std::size_t count, std::size_t grain, const Body& body) const {
        struct Work {
            const Body& body;
            std::atomic_flag has_failed = ATOMIC_FLAG_INIT;
            std::exception_ptr failure{};
        } work{body};
        host_->parallel_for(
            host_, count, grain,
            [](void* context, std::size_t begin, std::size_t end) {
                Work& the_work = *static_cast<Work*>(context);
                try {
                    the_work.body(begin, end);
                } catch (...) {
                    if (!the_work.has_failed.test_and_set())
                        the_work.failure = std::current_exception();
                }
            },
            &work);
        if (work.failure)
            std::rethrow_exception(work.failure);
    }

private:
    const hone_host* host_;
};

/// Whether a ray can hit anything at all (see hone_ray).
[[nodiscard]] inline bool isTraceable(const hone_ray& ray) {
    const auto is_in_range = [](float x) { return x < 1e18f && x > -1e18f; }; // NaN never is
    bool moves = false;
    for (int axis = 0; axis < 3; ++axis) {
        if (!is_in_range(ray.origin[axis]) || !is_in_range(ray.direction[axis]))
            return false;
        moves = moves || ray.direction[axis] != 0.0f;
    }
    return moves && ray.tmin <= ray.tmax && ray.tmax >= 0.0f;
}

namespace detail {

inline hone_status report(hone_error* error, hone_status status, const char* reason) {
    std::strncpy(error->text, reason, sizeof error->text - 1); // the rest is zeroed
    error->text[sizeof error->text - 1] = '\0';
    return status;
}

/// Runs what may throw and turns it into a status.
template <class Function>
hone_status guarded(hone_error* error, const Function& function) noexcept {
    try {
        function();
        return HONE_OK;
    } catch (const NoDevice& problem) {
        return report(error, HONE_NO_DEVICE, problem.what());
    } catch (const std::bad_alloc&) {
        return report(error, HONE_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& problem) {
        return report(error, HONE_FAILED, problem.what());
    } catch (...) {
        return report(error, HONE_FAILED, "it threw something that is no std::exception");
    }
}

/// What a plug-in says of itself, without what it offers.
inline hone_plugin describe(const About& about) {
    hone_plugin plugin{};
    plugin.magic = HONE_PLUGIN_MAGIC;
    plugin.struct_size = sizeof plugin;
    plugin.abi_major = HONE_PLUGIN_ABI_MAJOR;
    plugin.abi_minor = HONE_PLUGIN_ABI_MINOR;
    plugin.build = HONE_PLUGIN_BUILD;
    plugin.name = about.name;
    plugin.version = about.version;
    plugin.license = about.license;
    plugin.doc = about.doc;
    return plugin;
}

} // namespace detail

/// The functions of hone_trace_backend over a class.
template <class Tracer> class Border {
public:
    /// The table of a backend, for plug-ins that offer several.
    static hone_trace_backend table(const About& about) {
        return {.struct_size = sizeof(hone_trace_backend),
                .flags = about.flags | (kUpdates ? HONE_TRACE_UPDATES : 0u),
                .name = about.name,
                .doc = about.doc,
                .version = about.version,
                .runs_on = about.runs_on,
                .create = create,
                .destroy = destroy,
                .build = build,
                .update = kUpdates ? update : nullptr,
                .closest = closest,
                .occluded = occluded};
    }

private:
    static constexpr std::size_t kGrain = 256; ///< rays that a thread takes at once

    static constexpr bool kUpdates =
        requires(Tracer & tracer, const hone_scene& scene, std::span<const std::uint32_t> moved) {
        tracer.update(scene, moved);
    };

    struct Made {
        explicit Made(const hone_host& the_host) : host(the_host), tracer(host) {}
        Host host;
        Tracer tracer;
    };
    static Made& made(hone_tracer* tracer) { return *reinterpret_cast<Made*>(tracer); }

    static hone_status create(const hone_host* host, hone_tracer** tracer, hone_error* error) {
        return detail::guarded(error,
                               [&] { *tracer = reinterpret_cast<hone_tracer*>(new Made(*host)); });
    }

    static void destroy(hone_tracer* tracer) { delete &made(tracer); }

    static hone_status build(hone_tracer* tracer, const hone_scene* scene, hone_build_stats* stats,
                             hone_error* error) {
        return detail::guarded(error, [&] {
            Tracer& own = made(tracer).tracer;
            if constexpr (requires { own.build(*scene, *stats); })
                own.build(*scene, *stats);
            else
                own.build(*scene);
        });
    }

    static hone_status update(hone_tracer* tracer, const hone_scene* scene,
                              const std::uint32_t* moved, std::size_t moved_count,
                              hone_build_stats*, hone_error* error) {
        return detail::guarded(error, [&] {
            if constexpr (kUpdates)
                made(tracer).tracer.update(*scene, std::span(moved, moved_count));
        });
    }

    static hone_status closest(hone_tracer* tracer, const hone_ray* rays, hone_hit* hits,
                               std::size_t count, std::uint32_t flags, hone_error* error) {
        return detail::guarded(error, [&] {
            Made& own = made(tracer);
            if constexpr (requires {
                              own.tracer.closest(std::span(rays, count), std::span(hits, count),
                                                 flags);
                          })
                own.tracer.closest(std::span(rays, count), std::span(hits, count), flags);
            else
                own.host.parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i)
                        hits[i] = isTraceable(rays[i]) ? own.tracer.closest(rays[i]) : kMiss;
                });
        });
    }

    static hone_status occluded(hone_tracer* tracer, const hone_ray* rays, std::uint32_t* answers,
                                std::size_t count, std::uint32_t flags, hone_error* error) {
        return detail::guarded(error, [&] {
            Made& own = made(tracer);
            if constexpr (requires {
                              own.tracer.occluded(std::span(rays, count), std::span(answers, count),
                                                  flags);
                          })
                own.tracer.occluded(std::span(rays, count), std::span(answers, count), flags);
            else
                own.host.parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i)
                        answers[i] = isTraceable(rays[i]) && own.tracer.occluded(rays[i]) ? 1 : 0;
                });
        });
    }
};

/// The tables of a plug-in that offers one trace backend. Must not move.
template <class Tracer> struct Tables {
    explicit Tables(const About& about)
        : backend(Border<Tracer>::table(about)), plugin(detail::describe(about)) {
        plugin.trace_backends = &list;
        plugin.trace_backend_count = 1;
    }
    Tables(const Tables&) = delete;
    Tables& operator=(const Tables&) = delete;

    hone_trace_backend backend;
    const hone_trace_backend* list = &backend;
    hone_plugin plugin;
};

} // namespace hone::plugin

#pragma GCC visibility pop

/// Makes this library a plug-in that offers one trace backend. Once, outside of namespaces.
/// `...`: a hone::plugin::About in braces.
#define HONE_TRACE_PLUGIN(Tracer, ...)                                                             \
    const hone_plugin* hone_plugin_entry(uint32_t, uint32_t) {                                     \
        static const ::hone::plugin::Tables<Tracer> tables(::hone::plugin::About __VA_ARGS__);     \
        return &tables.plugin;                                                                     \
    }

#endif

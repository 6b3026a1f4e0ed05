// SPDX-License-Identifier: Apache-2.0
#pragma once

// The one file that knows which Embree it is built with. Embree 3 hands a query's flags and filter
// over in its context, Embree 4 in an arguments struct that points to the context.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "hone/core/trace/ray.glsl.h"

#include <array>
#include <utility>

namespace hone {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kSceneFlagQueryFilter = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using EmbreeContext = RTCIntersectContext;
inline constexpr RTCSceneFlags kSceneFlagQueryFilter = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

inline constexpr uint kPacket = 16;

struct EmbreePart;

/// What filter functions see of the query that they run in. Embree's context comes first: filters
/// get a pointer to it.
struct QueryContext {
    /// The best hit so far of a ray.
    struct Nearest {
        float t;
        Hit hit;
    };

    EmbreeContext embree;
    const Ray* rays;        ///< the list that is being answered; an Embree ray's id counts in it
    const EmbreePart* part; ///< the one that is being asked
    /// By ray id modulo kPacket, not by the filter's lane: Embree repacks lanes where 16 are not
    /// native.
    std::array<Nearest, kPacket> nearest;

    static QueryContext& of(const RTCFilterFunctionNArguments& arguments) {
        return *reinterpret_cast<QueryContext*>(arguments.context);
    }
};

/// A query of a list of rays: Embree's entry points under one spelling. Not copyable, because
/// Embree points into it; make one on each thread.
class EmbreeQuery {
public:
    EmbreeQuery(const EmbreeQuery&) = delete;
    EmbreeQuery& operator=(const EmbreeQuery&) = delete;
    /// `filter` is asked about every hit that the geometry's own filter let pass; may be null.
    EmbreeQuery(const Ray* rays, bool coherent, RTCFilterFunctionN filter) {
        context_.rays = rays;
#if RTC_VERSION_MAJOR >= 4
        rtcInitRayQueryContext(&context_.embree);
        int flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
        if (filter != nullptr)
            flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
        rtcInitIntersectArguments(&intersect_);
        intersect_.flags = static_cast<RTCRayQueryFlags>(flags);
        intersect_.context = &context_.embree;
        intersect_.filter = filter;
        rtcInitOccludedArguments(&occluded_);
        occluded_.flags = intersect_.flags;
        occluded_.context = &context_.embree;
        occluded_.filter = filter;
#else
        rtcInitIntersectContext(&context_.embree);
        context_.embree.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        context_.embree.filter = filter;
#endif
    }
    [[nodiscard]] QueryContext& context() {
        return context_;
    }

#if RTC_VERSION_MAJOR >= 4
    void intersect(RTCScene scene, RTCRayHit& ray) {
        rtcIntersect1(scene, &ray, &intersect_);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
        rtcIntersect16(valid, scene, &rays, &intersect_);
    }
    void occluded(RTCScene scene, RTCRay& ray) {
        rtcOccluded1(scene, &ray, &occluded_);
    }
    void occluded(RTCScene scene, const int* valid, RTCRay16& rays) {
        rtcOccluded16(valid, scene, &rays, &occluded_);
    }
#else
    void intersect(RTCScene scene, RTCRayHit& ray) {
        rtcIntersect1(scene, &context_.embree, &ray);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
        rtcIntersect16(valid, scene, &context_.embree, &rays);
    }
    void occluded(RTCScene scene, RTCRay& ray) {
        rtcOccluded1(scene, &context_.embree, &ray);
    }
    void occluded(RTCScene scene, const int* valid, RTCRay16& rays) {
        rtcOccluded16(valid, scene, &context_.embree, &rays);
    }
#endif

private:
    QueryContext context_{};
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments intersect_{};
    RTCOccludedArguments occluded_{};
#endif
};

/// What one lane of Embree's hits names (not a miss): geometry ids are instance numbers, whether
/// the triangle stands in the flat tree or in an Embree instance.
[[nodiscard]] inline Hit hitOf(RTCHitN* hits, uint count, uint lane) {
    const uint instance = RTCHitN_instID(hits, count, lane, 0);
    return {instance != RTC_INVALID_GEOMETRY_ID ? instance : RTCHitN_geomID(hits, count, lane),
            RTCHitN_primID(hits, count, lane)};
}

/// Owns a reference to an Embree object.
template <class Handle, void (*retain)(Handle), void (*release)(Handle)> class EmbreeOwner {
public:
    EmbreeOwner() = default;
    /// Takes over the reference that an rtcNew... function returned.
    explicit EmbreeOwner(Handle created) : handle_(created) {}
    EmbreeOwner(const EmbreeOwner& other) : handle_(other.handle_) {
        if (handle_ != nullptr)
            retain(handle_);
    }
    EmbreeOwner(EmbreeOwner&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    EmbreeOwner& operator=(EmbreeOwner other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~EmbreeOwner() {
        if (handle_ != nullptr)
            release(handle_);
    }
    [[nodiscard]] Handle handle() const { return handle_; }

private:
    Handle handle_ = nullptr;
};

using DeviceOwner = EmbreeOwner<RTCDevice, rtcRetainDevice, rtcReleaseDevice>;
using SceneOwner = EmbreeOwner<RTCScene, rtcRetainScene, rtcReleaseScene>;
using GeometryOwner = EmbreeOwner<RTCGeometry, rtcRetainGeometry, rtcReleaseGeometry>;

} // namespace hone

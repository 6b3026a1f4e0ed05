// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/bare_embree.h"

#include "hone/backends/embree/embree_shim.h"
#include "hone/core/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace hone {
namespace {

/// Rays of one task; measured best among 256 to 16384 on lists of a frame's size.
constexpr std::size_t kGrain = 1024;

/// Puts rays[first, first + 16) into lanes; lanes past the end repeat the last ray, untraced.
void fill(RTCRay16& packet, int (&valid)[kPacket], std::span<const Ray> rays, std::size_t first) {
    for (std::size_t lane = 0; lane < kPacket; ++lane) {
        valid[lane] = first + lane < rays.size() ? -1 : 0;
        const Ray& ray = rays[std::min(first + lane, rays.size() - 1)];
        packet.org_x[lane] = ray.origin.x;
        packet.org_y[lane] = ray.origin.y;
        packet.org_z[lane] = ray.origin.z;
        packet.tnear[lane] = ray.tmin;
        packet.dir_x[lane] = ray.direction.x;
        packet.dir_y[lane] = ray.direction.y;
        packet.dir_z[lane] = ray.direction.z;
        packet.time[lane] = 0;
        packet.tfar[lane] = ray.tmax;
        packet.mask[lane] = ~0u;
        packet.id[lane] = static_cast<uint>(lane);
        packet.flags[lane] = 0;
    }
}

template <class Body> void forEachChunk(std::size_t count, const Body& body) {
    tbb::parallel_for(std::size_t{0}, (count + kGrain - 1) / kGrain, [&](std::size_t chunk) {
        body(chunk * kGrain, std::min((chunk + 1) * kGrain, count));
    });
}

} // namespace

struct BareEmbree::Tree {
    DeviceOwner device{rtcNewDevice(nullptr)};
    SceneOwner scene;
};

BareEmbree::BareEmbree(const Scene& scene) : tree_(std::make_unique<Tree>()) {
    if (tree_->device.handle() == nullptr)
        throw DeviceError("rtcNewDevice failed");
    tree_->scene = SceneOwner(rtcNewScene(tree_->device.handle()));
    rtcSetSceneBuildQuality(tree_->scene.handle(), RTC_BUILD_QUALITY_HIGH);
    for (uint index = 0; index < scene.instances.size(); ++index) {
        const Instance& instance = scene.instances[index];
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (mesh.triangle_count == 0)
            continue;

        // The stretch of positions that the mesh uses, placed in the world.
        const std::span<const uvec3> triangles(scene.triangles.data() + mesh.first_triangle,
                                               mesh.triangle_count);
        uint low = kNone, high = 0;
        for (const uvec3& corners : triangles) {
            low = std::min({low, corners.x, corners.y, corners.z});
            high = std::max({high, corners.x, corners.y, corners.z});
        }
        const GeometryOwner geometry(
            rtcNewGeometry(tree_->device.handle(), RTC_GEOMETRY_TYPE_TRIANGLE));
        auto* vertices = static_cast<vec3*>(
            rtcSetNewGeometryBuffer(geometry.handle(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(vec3), high - low + 1));
        auto* indices = static_cast<uvec3*>(
            rtcSetNewGeometryBuffer(geometry.handle(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(uvec3), triangles.size()));
        if (vertices == nullptr || indices == nullptr)
            throw OutOfMemory("rtcSetNewGeometryBuffer: Embree has no memory for the scene");
        for (uint position = low; position <= high; ++position)
            vertices[position - low] = instance.to_world * vec4(scene.positions[position], 1.0f);
        std::ranges::transform(triangles, indices,
                               [low](uvec3 corners) { return corners - uvec3(low); });
        rtcCommitGeometry(geometry.handle());
        rtcAttachGeometryByID(tree_->scene.handle(), geometry.handle(), index);
    }
    rtcCommitScene(tree_->scene.handle());
    if (rtcGetDeviceError(tree_->device.handle()) != RTC_ERROR_NONE)
        throw DeviceError("rtcCommitScene failed");
}

BareEmbree::~BareEmbree() = default;

void BareEmbree::closest(std::span<const Ray> rays, std::span<Hit> hits,
                         Coherence coherence) const {
    forEachChunk(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(nullptr, coherence == Coherence::kCoherent, nullptr);
        alignas(64) RTCRayHit16 packet;
        alignas(64) int valid[kPacket];
        for (std::size_t first = begin; first < end; first += kPacket) {
            fill(packet.ray, valid, rays, first);
            std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
            std::ranges::fill(packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
            query.intersect(tree_->scene.handle(), valid, packet);
            for (std::size_t lane = 0; lane < kPacket && first + lane < end; ++lane)
                hits[first + lane] = packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID
                                         ? Hit{kNone, kNone}
                                         : Hit{packet.hit.geomID[lane], packet.hit.primID[lane]};
        }
    });
}

void BareEmbree::occluded(std::span<const Ray> rays, std::span<uint> occluded,
                          Coherence coherence) const {
    forEachChunk(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(nullptr, coherence == Coherence::kCoherent, nullptr);
        alignas(64) RTCRay16 packet;
        alignas(64) int valid[kPacket];
        for (std::size_t first = begin; first < end; first += kPacket) {
            fill(packet, valid, rays, first);
            query.occluded(tree_->scene.handle(), valid, packet);
            for (std::size_t lane = 0; lane < kPacket && first + lane < end; ++lane)
                occluded[first + lane] = packet.tfar[lane] < 0 ? 1u : 0u;
        }
    });
}

} // namespace hone

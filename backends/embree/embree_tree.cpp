// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/embree_tree.h"

#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/core/trace/instancing.h"

#include <algorithm>
#include <span>

namespace hone {
namespace {

const char* errorName(RTCError error) {
    switch (error) {
    case RTC_ERROR_NONE:
        return "RTC_ERROR_NONE";
    case RTC_ERROR_INVALID_ARGUMENT:
        return "RTC_ERROR_INVALID_ARGUMENT";
    case RTC_ERROR_INVALID_OPERATION:
        return "RTC_ERROR_INVALID_OPERATION";
    case RTC_ERROR_OUT_OF_MEMORY:
        return "RTC_ERROR_OUT_OF_MEMORY";
    case RTC_ERROR_UNSUPPORTED_CPU:
        return "RTC_ERROR_UNSUPPORTED_CPU";
    case RTC_ERROR_CANCELLED:
        return "RTC_ERROR_CANCELLED";
    default:
        return "RTC_ERROR_UNKNOWN";
    }
}

/// How much further than the nearest hit candidates are still asked for: more than kernels'
/// rounding of t, so that the nearest one cannot be lost to the order in which they come.
constexpr float kSlack = 1.00001f;

/// Whether a hit comes before the nearest so far, in the order (t, instance, primitive).
bool isNearer(float t, Hit hit, const QueryContext::Nearest& nearest) {
    if (t != nearest.t)
        return t < nearest.t;
    if (hit.instance != nearest.hit.instance)
        return hit.instance < nearest.hit.instance;
    return hit.primitive < nearest.hit.primitive;
}

} // namespace

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr)) {
    if (handle() == nullptr)
        throw DeviceError(std::string("rtcNewDevice failed: ") +
                          errorName(rtcGetDeviceError(nullptr)) +
                          "; Embree " RTC_VERSION_STRING " needs a 64-bit processor with SSE2");
    rtcSetDeviceErrorFunction(
        handle(),
        [](void* self, RTCError code, const char* text) {
            logger().debug("Embree: {}: {}", errorName(code), text != nullptr ? text : "");
            RTCError none = RTC_ERROR_NONE;
            static_cast<EmbreeDevice*>(self)->error_.compare_exchange_strong(none, code);
        },
        this);
    rtcSetDeviceMemoryMonitorFunction(
        handle(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->bytes_ += bytes;
            return true;
        },
        this);
}

std::size_t EmbreeDevice::bytes() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(bytes_, 0));
}

void EmbreeDevice::check(const char* call) {
    const RTCError error = error_.exchange(RTC_ERROR_NONE);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw OutOfMemory(std::string(call) + ": Embree has no memory for the scene");
    if (error != RTC_ERROR_NONE)
        throw DeviceError(std::string(call) + " failed: " + errorName(error));
}

EmbreeTree::EmbreeTree(EmbreeDevice& device, const Scene& scene, std::size_t flatten_triangles)
    : source_(&scene), surface_(scene), facing_(scene.instances.size(), 0.0f),
      is_instanced_(chooseInstanced(scene, flatten_triangles)), mesh_trees_(scene.meshes.size()),
      slots_(scene.positions.size(), kNone), scene_(makeScene(device)) {
    for (uint index = 0; index < scene.instances.size(); ++index)
        addInstance(device, index);
    rtcCommitScene(handle());
    device.check("rtcCommitScene");
    slots_ = {};
}

SceneOwner EmbreeTree::makeScene(EmbreeDevice& device) const {
    SceneOwner scene(rtcNewScene(device.handle()));
    device.check("rtcNewScene");
    rtcSetSceneBuildQuality(scene.handle(), RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene.handle(), kSceneFlagQueryFilter);
    return scene;
}

void EmbreeTree::addInstance(EmbreeDevice& device, uint index) {
    const Instance& instance = source_->instances[index];
    const Mesh& mesh = source_->meshes[instance.mesh];
    if (mesh.triangle_count == 0)
        return;
    const bool instanced = is_instanced_[instance.mesh] != 0;
    if ((source_->materials[mesh.material].flags & kMaterialTwoSided) == 0) {
        // In an instanced mesh's own space front faces turn counter-clockwise even if it is
        // flipped.
        facing_[index] = instance.flipped != 0 && !instanced ? -1.0f : 1.0f;
    }
    if (!instanced) {
        const GeometryOwner geometry = makeTriangles(device, mesh, &instance);
        rtcAttachGeometryByID(handle(), geometry.handle(), index);
        return;
    }

    has_instances_ = true;

    // A tree for the mesh, when its first instance comes.
    SceneOwner& tree = mesh_trees_[instance.mesh];
    if (tree.handle() == nullptr) {
        tree = makeScene(device);
        const GeometryOwner geometry = makeTriangles(device, mesh, nullptr);
        rtcAttachGeometry(tree.handle(), geometry.handle());
        rtcCommitScene(tree.handle());
        device.check("rtcCommitScene");
    }
    const GeometryOwner placed(rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_INSTANCE));
    device.check("rtcNewGeometry");
    rtcSetGeometryInstancedScene(placed.handle(), tree.handle());
    rtcSetGeometryTransform(placed.handle(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                            &instance.to_world);
    rtcCommitGeometry(placed.handle());
    rtcAttachGeometryByID(handle(), placed.handle(), index);
}

GeometryOwner EmbreeTree::makeTriangles(EmbreeDevice& device, const Mesh& mesh,
                                        const Instance* placed) {
    GeometryOwner geometry(rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_TRIANGLE));
    device.check("rtcNewGeometry");
    const std::span<const uvec3> triangles(source_->triangles.data() + mesh.first_triangle,
                                           mesh.triangle_count);

    // Number the positions that the mesh uses, in the order of their first use.
    std::vector<uint> used;
    for (const uvec3& corners : triangles)
        for (const uint position : {corners.x, corners.y, corners.z})
            if (slots_[position] == kNone) {
                slots_[position] = static_cast<uint>(used.size());
                used.push_back(position);
            }

    // Embree's own buffers come with the padding that it wants.
    auto* vertices =
        static_cast<vec3*>(rtcSetNewGeometryBuffer(geometry.handle(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                   RTC_FORMAT_FLOAT3, sizeof(vec3), used.size()));
    auto* indices = static_cast<uvec3*>(
        rtcSetNewGeometryBuffer(geometry.handle(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(uvec3), triangles.size()));
    device.check("rtcSetNewGeometryBuffer");
    for (std::size_t i = 0; i < used.size(); ++i)
        vertices[i] = placed != nullptr ? surface_.worldPosition(*placed, used[i])
                                        : source_->positions[used[i]];
    for (std::size_t i = 0; i < triangles.size(); ++i)
        indices[i] = uvec3(slots_[triangles[i].x], slots_[triangles[i].y], slots_[triangles[i].z]);
    for (const uint position : used)
        slots_[position] = kNone;

    rtcSetGeometryUserData(geometry.handle(), this);
    if ((source_->materials[mesh.material].flags & kMaterialMasked) != 0) {
        rtcSetGeometryIntersectFilterFunction(geometry.handle(), rejectHoles);
        rtcSetGeometryOccludedFilterFunction(geometry.handle(), rejectHoles);
    }
    rtcCommitGeometry(geometry.handle());
    device.check("rtcCommitGeometry");
    triangles_ += triangles.size();
    return geometry;
}

void EmbreeTree::rejectHoles(const RTCFilterFunctionNArguments* arguments) {
    const auto& tree = *static_cast<const EmbreeTree*>(arguments->geometryUserPtr);
    const Ray* rays = QueryContext::of(*arguments).rays;
    const uint count = arguments->N;
    for (uint i = 0; i < count; ++i) {
        if (arguments->valid[i] == 0)
            continue;
        // The ray as it was asked: Embree's copy may stand in an instance's space.
        const Ray& ray = rays[RTCRayN_id(arguments->ray, count, i)];
        if (!tree.surface_.isSolid(ray, hitOf(arguments->hit, count, i)))
            arguments->valid[i] = 0;
    }
}

void EmbreeTree::keepNearest(const RTCFilterFunctionNArguments* arguments) {
    const auto& tree = *static_cast<const EmbreeTree*>(arguments->geometryUserPtr);
    const float* facing = tree.facing_.data();
    auto& nearest_of = QueryContext::of(*arguments).nearest;
    RTCRayN* rays = arguments->ray;
    RTCHitN* hits = arguments->hit;
    const uint count = arguments->N;
    for (uint i = 0; i < count; ++i) {
        if (arguments->valid[i] == 0)
            continue;
        QueryContext::Nearest& nearest = nearest_of[RTCRayN_id(rays, count, i) % kPacket];
        float& t = RTCRayN_tfar(rays, count, i); // the candidate's
        const Hit hit = hitOf(hits, count, i);
        // Ray and normal stand in the same space here, the mesh's own if it is instanced.
        const float slope = RTCRayN_dir_x(rays, count, i) * RTCHitN_Ng_x(hits, count, i) +
                            RTCRayN_dir_y(rays, count, i) * RTCHitN_Ng_y(hits, count, i) +
                            RTCRayN_dir_z(rays, count, i) * RTCHitN_Ng_z(hits, count, i);
        const bool is_unseen = facing[hit.instance] * slope > 0.0f;
        if (is_unseen || !isNearer(t, hit, nearest)) {
            arguments->valid[i] = 0;
            continue;
        }
        nearest = {t, hit};
        t *= kSlack; // Embree goes on with the range that an accepting filter leaves
    }
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/embree_tree.h"

#include "hone/core/error.h"
#include "hone/core/trace/instancing.h"

namespace hone {
namespace {

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

/// The still part's tree is built anew without what left it once that is an eighth of it: rays
/// visit what is not there.
constexpr std::size_t kStillShare = 8;

void setTransform(RTCGeometry placed, const Instance& instance) {
    rtcSetGeometryTransform(placed, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &instance.to_world);
}

} // namespace

EmbreeTree::EmbreeTree(EmbreeDevice& device, const Scene& scene, std::size_t flatten_triangles)
    : device_(&device), source_(&scene), surface_(scene),
      is_instanced_(chooseInstanced(scene, flatten_triangles)),
      vertices_(scene, surface_, is_instanced_), mesh_trees_(scene.meshes.size()),
      moving_things_(scene.instances.size()) {
    buildStill();
    for (uint index = 0; index < scene.instances.size(); ++index)
        if (!isInstanced(index))
            triangles_ += meshOf(index).triangle_count;
    for (std::size_t mesh = 0; mesh < mesh_trees_.size(); ++mesh)
        if (mesh_trees_[mesh].handle() != nullptr)
            triangles_ += scene.meshes[mesh].triangle_count;
}

const Mesh& EmbreeTree::meshOf(uint index) const {
    return source_->meshes[source_->instances[index].mesh];
}

bool EmbreeTree::isInstanced(uint index) const {
    return is_instanced_[source_->instances[index].mesh] != 0;
}

EmbreePart::Facing EmbreeTree::facingOf(uint index) const {
    if ((source_->materials[meshOf(index).material].flags & kMaterialTwoSided) != 0)
        return {};
    // In an instanced mesh's own space front faces turn counter-clockwise even if it is flipped.
    const bool turns = source_->instances[index].flipped != 0 && !isInstanced(index);
    return {.back_sign = turns ? -1.0f : 1.0f};
}

/// How much of a tree an instance is.
std::size_t EmbreeTree::weightOf(uint index) const {
    return isInstanced(index) ? 1 : meshOf(index).triangle_count;
}

SceneOwner EmbreeTree::makeScene(RTCBuildQuality quality, RTCSceneFlags flags) {
    SceneOwner scene(rtcNewScene(device_->handle()));
    device_->check("rtcNewScene");
    rtcSetSceneBuildQuality(scene.handle(), quality);
    rtcSetSceneFlags(scene.handle(), flags);
    return scene;
}

void EmbreeTree::commit(RTCScene scene) {
    rtcCommitScene(scene);
    device_->check("rtcCommitScene");
}

/// Builds a tree of the instances that never moved, with spatial splits.
void EmbreeTree::buildStill() {
    still() = {}; // the old tree's memory first
    still().scene = makeScene(RTC_BUILD_QUALITY_HIGH, kSceneFlagQueryFilter);
    still().facing.resize(source_->instances.size());
    still_weight_ = left_weight_ = 0;
    for (uint index = 0; index < source_->instances.size(); ++index) {
        if (meshOf(index).triangle_count == 0 || moving_things_[index].handle() != nullptr)
            continue;
        still().facing[index] = facingOf(index);
        still_weight_ += weightOf(index);
        const GeometryOwner thing = makeGeometry(index, RTC_BUILD_QUALITY_HIGH);
        rtcAttachGeometryByID(still().scene.handle(), thing.handle(), index);
    }
    commit(still().scene.handle());
}

bool EmbreeTree::move(std::span<const uint> moved) {
    if (moved.empty())
        return true;
    for (const uint index : moved)
        if (isInstanced(index) && !isInvertible(source_->instances[index]))
            return false;

    if (moving().scene.handle() == nullptr) {
        // Of low quality means: a tree for each geometry, and one above them.
        moving().scene =
            makeScene(RTC_BUILD_QUALITY_LOW,
                      static_cast<RTCSceneFlags>(kSceneFlagQueryFilter | RTC_SCENE_FLAG_DYNAMIC));
        moving().facing.resize(source_->instances.size());
    }
    for (const uint index : moved) {
        if (meshOf(index).triangle_count == 0)
            continue;
        if (moving_things_[index].handle() == nullptr)
            enterMoving(index);
        else
            follow(index);
        moving().facing[index] = facingOf(index);
    }
    commit(moving().scene.handle());
    if (left_weight_ * kStillShare > still_weight_)
        buildStill();
    return true;
}

void EmbreeTree::enterMoving(uint index) {
    still().facing[index].has_left = true;
    left_weight_ += weightOf(index);
    moving_things_[index] = makeGeometry(index, RTC_BUILD_QUALITY_REFIT);
    rtcAttachGeometryByID(moving().scene.handle(), moving_things_[index].handle(), index);
}

void EmbreeTree::follow(uint index) {
    const RTCGeometry thing = moving_things_[index].handle();
    if (isInstanced(index)) {
        setTransform(thing, source_->instances[index]);
    } else {
        static_cast<void>(vertices_.place(index)); // where they are, Embree knows
        rtcUpdateGeometryBuffer(thing, RTC_BUFFER_TYPE_VERTEX, 0);
    }
    rtcCommitGeometry(thing);
    device_->check("rtcCommitGeometry");
}

GeometryOwner EmbreeTree::makeGeometry(uint index, RTCBuildQuality quality) {
    const Instance& instance = source_->instances[index];
    const Mesh& mesh = source_->meshes[instance.mesh];
    if (!isInstanced(index))
        return makeTriangles(mesh, vertices_.place(index), quality);

    has_instances_ = true;

    // A tree for the mesh, when its first instance comes.
    SceneOwner& tree = mesh_trees_[instance.mesh];
    if (tree.handle() == nullptr) {
        tree = makeScene(RTC_BUILD_QUALITY_HIGH, kSceneFlagQueryFilter);
        const GeometryOwner triangles =
            makeTriangles(mesh, source_->positions, RTC_BUILD_QUALITY_HIGH);
        rtcAttachGeometry(tree.handle(), triangles.handle());
        commit(tree.handle());
    }
    GeometryOwner placed(rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_INSTANCE));
    device_->check("rtcNewGeometry");
    rtcSetGeometryInstancedScene(placed.handle(), tree.handle());
    setTransform(placed.handle(), instance);
    rtcCommitGeometry(placed.handle());
    device_->check("rtcCommitGeometry");
    return placed;
}

/// A mesh over the scene's own triangles; `vertices` are numbered as Scene::positions are.
GeometryOwner EmbreeTree::makeTriangles(const Mesh& mesh, std::span<const vec3> vertices,
                                        RTCBuildQuality quality) {
    GeometryOwner geometry(rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_TRIANGLE));
    device_->check("rtcNewGeometry");
    rtcSetSharedGeometryBuffer(geometry.handle(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices.data(), 0, sizeof(vec3), vertices.size());
    rtcSetSharedGeometryBuffer(geometry.handle(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               &source_->triangles[mesh.first_triangle], 0, sizeof(uvec3),
                               mesh.triangle_count);
    device_->check("rtcSetSharedGeometryBuffer");
    rtcSetGeometryBuildQuality(geometry.handle(), quality);
    rtcSetGeometryUserData(geometry.handle(), this);
    if ((source_->materials[mesh.material].flags & kMaterialMasked) != 0) {
        rtcSetGeometryIntersectFilterFunction(geometry.handle(), rejectHoles);
        rtcSetGeometryOccludedFilterFunction(geometry.handle(), rejectHoles);
    }
    rtcCommitGeometry(geometry.handle());
    device_->check("rtcCommitGeometry");
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

void EmbreeTree::rejectLeft(const RTCFilterFunctionNArguments* arguments) {
    const EmbreePart::Facing* facing = QueryContext::of(*arguments).part->facing.data();
    const uint count = arguments->N;
    for (uint i = 0; i < count; ++i)
        if (arguments->valid[i] != 0 && facing[hitOf(arguments->hit, count, i).instance].has_left)
            arguments->valid[i] = 0;
}

void EmbreeTree::keepNearest(const RTCFilterFunctionNArguments* arguments) {
    QueryContext& context = QueryContext::of(*arguments);
    const EmbreePart::Facing* facing_of = context.part->facing.data();
    RTCRayN* rays = arguments->ray;
    RTCHitN* hits = arguments->hit;
    const uint count = arguments->N;
    for (uint i = 0; i < count; ++i) {
        if (arguments->valid[i] == 0)
            continue;
        QueryContext::Nearest& nearest = context.nearest[RTCRayN_id(rays, count, i) % kPacket];
        float& t = RTCRayN_tfar(rays, count, i); // the candidate's
        const Hit hit = hitOf(hits, count, i);
        // Ray and normal stand in the same space here, the mesh's own if it is instanced.
        const float slope = RTCRayN_dir_x(rays, count, i) * RTCHitN_Ng_x(hits, count, i) +
                            RTCRayN_dir_y(rays, count, i) * RTCHitN_Ng_y(hits, count, i) +
                            RTCRayN_dir_z(rays, count, i) * RTCHitN_Ng_z(hits, count, i);
        const EmbreePart::Facing facing = facing_of[hit.instance];
        const bool is_unseen = facing.back_sign * slope > 0.0f || facing.has_left;
        if (is_unseen || !isNearer(t, hit, nearest)) {
            arguments->valid[i] = 0;
            continue;
        }
        nearest = {t, hit};
        t *= kSlack; // Embree goes on with the range that an accepting filter leaves
    }
}

} // namespace hone

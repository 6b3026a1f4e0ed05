// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_scene_tree.h"

#include "hone/core/error.h"
#include "hone/core/trace/instancing.h"

#include <algorithm>
#include <cstring>

namespace hone {
namespace {

constexpr VkBufferUsageFlags kBuildInput =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
/// Where instances may begin, by the standard.
constexpr VkDeviceSize kInstanceAlignment = 16;

VkTransformMatrixKHR transformOf(const mat4x3& to_world) {
    VkTransformMatrixKHR result;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            result.matrix[row][column] = to_world[column][row];
    return result;
}

VkAccelerationStructureInstanceKHR placeTree(const mat4x3& to_world, bool is_two_sided,
                                             VkDeviceAddress tree) {
    // Vulkan takes for front faces what turns clockwise in left-handed axes, which is
    // counter-clockwise in ours. It judges in the structure's own space, so a flipped instance
    // needs nothing.
    constexpr VkGeometryInstanceFlagsKHR kTwoSided =
        VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    VkAccelerationStructureInstanceKHR result{};
    result.transform = transformOf(to_world);
    result.mask = 0xff;
    result.flags = (is_two_sided ? kTwoSided : 0u) & 0xffu;
    result.accelerationStructureReference = tree;
    return result;
}

} // namespace

VulkanSceneTree::VulkanSceneTree(Device& device, const Scene& scene, const RayTracerParams& params,
                                 bool is_refitted)
    : device_(&device), inside_(insideOf(device)), scene_(&scene), surface_(scene), params_(params),
      is_refitted_(is_refitted), is_instanced_(chooseInstanced(scene, params.flatten_triangles)),
      by_instance_(scene.instances.size()), by_mesh_(scene.meshes.size()) {
    TriangleSoup soup;
    addFlat(soup);
    const auto flat_end = static_cast<uint>(soup.names.size());
    addMeshes(soup);
    triangles_ = soup.names.size();
    if (empty())
        return;
    names_ = device.createBuffer(triangles_ * sizeof(Hit), "tree_triangles");
    std::memcpy(names_.view().data, soup.names.data(), names_.bytes());
    corners_ = upload(soup, {0, flat_end});
    const AddressedBuffer meshes =
        upload(soup, {flat_end, static_cast<uint>(triangles_) - flat_end});
    soup = {};

    makeInputs(meshes);
    flat_store_ = TreeStore(inside_, flat_inputs_, "flat trees");
    mesh_store_ = TreeStore(inside_, mesh_inputs_, "mesh trees");
    writePlaces();
    top_store_ = TreeStore(inside_, top_input_, "tree of trees");
    build();
}

bool VulkanSceneTree::isInstanced(uint instance) const {
    return is_instanced_[scene_->instances[instance].mesh] != 0;
}

uint VulkanSceneTree::flagsOf(uint mesh) const {
    return scene_->materials[scene_->meshes[mesh].material].flags;
}

std::vector<std::vector<uint>> VulkanSceneTree::groupFlat() const {
    const bool is_apart = device_->info().is_software && by_instance_.size() <= params_.most_apart;
    std::vector<std::vector<uint>> groups(is_apart ? by_instance_.size() : 2);
    for (uint i = 0; i < by_instance_.size(); ++i) {
        const bool is_two_sided = (flagsOf(scene_->instances[i].mesh) & kMaterialTwoSided) != 0;
        if (!isInstanced(i))
            groups[is_apart ? i : is_two_sided ? 1 : 0].push_back(i);
    }
    return groups;
}

void VulkanSceneTree::addFlat(TriangleSoup& soup) {
    const auto end = [&soup] { return static_cast<uint>(soup.names.size()); };
    for (const std::vector<uint>& group : groupFlat()) {
        const uint before = end();
        FlatTree tree;
        for (const uint masked : {0u, kMaterialMasked}) {
            Stretch& geometry = tree.geometries[masked != 0 ? 1 : 0];
            geometry.first = end();
            for (const uint i : group) {
                const uint flags = flagsOf(scene_->instances[i].mesh);
                if ((flags & kMaterialMasked) != masked)
                    continue;
                tree.is_two_sided = (flags & kMaterialTwoSided) != 0;
                by_instance_[i].first = end();
                soup.addInstance(*scene_, surface_, i);
                by_instance_[i].count = end() - by_instance_[i].first;
            }
            geometry.count = end() - geometry.first;
        }
        if (end() > before)
            flat_.push_back(tree);
    }
}

void VulkanSceneTree::addMeshes(TriangleSoup& soup) {
    for (uint mesh = 0; mesh < by_mesh_.size(); ++mesh) {
        if (is_instanced_[mesh] == 0)
            continue;
        by_mesh_[mesh].first = static_cast<uint>(soup.names.size());
        soup.addMesh(*scene_, mesh);
        by_mesh_[mesh].count = static_cast<uint>(soup.names.size()) - by_mesh_[mesh].first;
    }
}

AddressedBuffer VulkanSceneTree::upload(const TriangleSoup& soup, Stretch stretch) const {
    if (stretch.count == 0)
        return {};
    const std::span corners = std::span(soup.corners).subspan(stretch.first, stretch.count);
    AddressedBuffer buffer(inside_.context(), inside_.resources->memory, corners.size_bytes(),
                           kBuildInput, AddressedBuffer::Place::kMapped, "corners of triangles");
    std::ranges::copy(corners, buffer.as<std::array<vec3, 3>>().begin());
    return buffer;
}

void VulkanSceneTree::makeInputs(const AddressedBuffer& meshes) {
    constexpr VkDeviceSize kBytes = 3 * sizeof(vec3);
    for (const FlatTree& tree : flat_) {
        TreeInput& input = flat_inputs_.emplace_back();
        input.is_refitted = is_refitted_;
        for (std::size_t masked = 0; masked < 2; ++masked)
            if (const Stretch stretch = tree.geometries[masked]; stretch.count > 0)
                input.addTriangles(corners_.address() + stretch.first * kBytes, stretch.count,
                                   masked == 0);
    }
    uint first = kNone; // of all instanced meshes
    for (uint mesh = 0; mesh < by_mesh_.size(); ++mesh) {
        const Stretch stretch = by_mesh_[mesh];
        if (stretch.count == 0)
            continue;
        first = std::min(first, stretch.first);
        mesh_inputs_.emplace_back().addTriangles(
            meshes.address() + (stretch.first - first) * kBytes, stretch.count,
            (flagsOf(mesh) & kMaterialMasked) == 0);
    }
}

void VulkanSceneTree::writePlaces() {
    std::vector<VkAccelerationStructureInstanceKHR> placed;
    std::vector<TreePlace> places;
    for (std::size_t i = 0; i < flat_.size(); ++i) {
        const auto& [opaque, masked] = flat_[i].geometries;
        placed.push_back(placeTree(mat4x3(1.0f), flat_[i].is_two_sided, flat_store_.address(i)));
        // Geometries without triangles are left out, so the masked one may be the first.
        places.push_back({kNone, opaque.count > 0 ? opaque.first : masked.first, masked.first});
    }
    std::vector<std::size_t> tree_of(by_mesh_.size(), 0);
    for (std::size_t mesh = 0, tree = 0; mesh < by_mesh_.size(); ++mesh)
        if (by_mesh_[mesh].count > 0)
            tree_of[mesh] = tree++;
    for (uint i = 0; i < by_instance_.size(); ++i) {
        const Instance& instance = scene_->instances[i];
        const Stretch stretch = by_mesh_[instance.mesh];
        if (stretch.count == 0)
            continue;
        const bool is_two_sided = (flagsOf(instance.mesh) & kMaterialTwoSided) != 0;
        placed.push_back(placeTree(instance.to_world, is_two_sided,
                                   mesh_store_.address(tree_of[instance.mesh])));
        places.push_back({i, stretch.first, stretch.first});
    }

    // An update writes as many as there were.
    if (top_input_.empty()) {
        places_ = device_->createBuffer(places.size() * sizeof(TreePlace), "tree_places");
        placed_ = AddressedBuffer(
            inside_.context(), inside_.resources->memory, placed.size() * sizeof(placed[0]),
            kBuildInput, AddressedBuffer::Place::kMapped, "placed trees", kInstanceAlignment);
        top_input_.emplace_back().addInstances(placed_.address(),
                                               static_cast<std::uint32_t>(placed.size()));
    }
    std::ranges::copy(placed, placed_.as<VkAccelerationStructureInstanceKHR>().begin());
    std::ranges::copy(places, places_.as<TreePlace>().begin());
}

void VulkanSceneTree::build() {
    flat_store_.record(inside_, flat_inputs_, TreeStore::Build::kAnew);
    mesh_store_.record(inside_, mesh_inputs_, TreeStore::Build::kAnew);
    top_store_.record(inside_, top_input_, TreeStore::Build::kAnew);
    inside_.encoder->finish();

    // What no update needs.
    mesh_store_.releaseScratch();
    if (is_refitted_)
        return;
    flat_store_.releaseScratch();
    top_store_.releaseScratch();
    corners_ = {};
    placed_ = {};
}

bool VulkanSceneTree::update(std::span<const uint> moved) {
    HONE_ASSERT(is_refitted_, "update() of a tree that was built to stay");
    for (FlatTree& tree : flat_)
        tree.moved = 0;

    // Place the triangles of flat instances anew; their names must be those that they had.
    TriangleSoup soup;
    for (const uint i : moved) {
        if (isInstanced(i)) {
            if (!isInvertible(scene_->instances[i]))
                return false;
            continue;
        }
        soup.corners.clear();
        soup.names.clear();
        soup.addInstance(*scene_, surface_, i);
        const Stretch stretch = by_instance_[i];
        const auto names = names_.as<Hit>().subspan(stretch.first, stretch.count);
        const auto is_same = [](Hit a, Hit b) { return a.primitive == b.primitive; };
        if (!std::ranges::equal(soup.names, names, is_same))
            return false;
        if (stretch.count == 0)
            continue;
        std::ranges::copy(soup.corners, corners_.as<std::array<vec3, 3>>().begin() + stretch.first);
        for (FlatTree& tree : flat_)
            for (const Stretch& geometry : tree.geometries)
                if (stretch.first >= geometry.first && stretch.end() <= geometry.end())
                    tree.moved += stretch.count;
    }

    for (std::size_t i = 0; i < flat_.size(); ++i)
        if (flat_[i].moved > 0)
            flat_store_.record(inside_, flat_inputs_[i], i, TreeStore::Build::kRefit);
    writePlaces();
    top_store_.record(inside_, top_input_, TreeStore::Build::kAnew);
    inside_.encoder->finish();
    return true;
}

uvec2 VulkanSceneTree::address() const {
    const VkDeviceAddress address = top_store_.address(0);
    return {static_cast<uint>(address), static_cast<uint>(address >> 32)};
}

void VulkanSceneTree::bind(Arguments& arguments) const {
    arguments.bind("tree_places", places_.view());
    arguments.bind("tree_triangles", names_.view());
}

std::size_t VulkanSceneTree::bytes() const {
    return flat_store_.bytes() + mesh_store_.bytes() + top_store_.bytes() + names_.bytes() +
           places_.bytes() + corners_.bytes() + placed_.bytes();
}

} // namespace hone

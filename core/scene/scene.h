// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/page_allocator.h"
#include "hone/core/math.h"
#include "hone/core/scene/scene.glsl.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// A camera as people write it.
struct CameraDesc {
    std::string name;
    vec3 position{0, 0, 0};
    vec3 target{0, 0, -1};
    vec3 up{0, 1, 0};
    float fov_y_degrees = 60;
    float near = 0.01f;
    float aperture = 0; ///< diameter of a thin lens in metres; 0 = a pinhole
    float focus = 1;    ///< view depth in metres that the lens images sharply
};

/// A camera at a time of a path.
struct CameraKey {
    float time = 0; ///< seconds
    CameraDesc camera;
};

/// How a camera moves; camera_path.h says where it is in between.
struct CameraPath {
    std::string name;
    std::vector<CameraKey> keys; ///< at least one, times ascending
};

/// The camera's axes made orthonormal. Throws SceneError if position equals target, up is parallel
/// to the view, or a number is out of its range.
[[nodiscard]] Camera makeCamera(const CameraDesc& desc);

struct Bounds {
    vec3 low{1e30f};
    vec3 high{-1e30f};
    void add(vec3 point);
    [[nodiscard]] bool empty() const { return low.x > high.x; }
    [[nodiscard]] vec3 center() const { return 0.5f * (low + high); }
};

/// Everything that is drawn and traced: plain arrays in the layouts of scene.glsl.h, world in
/// metres, y up.
///
/// Whoever fills it calls finishScene() once at the end; after that it is read only, except through
/// functions below that say so. Names are untrusted text.
///
/// The arrays exist once: devices and tracers use them where they are. So, while buffers
/// (SceneBuffers) or a tracer were made for it, no array may grow, shrink or move, the scene itself
/// included; what stands in them may change between runs (moveInstance, touch).
struct Scene {
    PagedVector<vec3> positions;  ///< object space
    PagedVector<vec3> normals;    ///< unit, as many as positions
    PagedVector<vec2> uvs;        ///< as many as positions; (0,0) is the texture's top left
    PagedVector<uvec3> triangles; ///< indices into positions; a mesh's are consecutive
    PagedVector<Mesh> meshes;
    PagedVector<Cluster> clusters;
    PagedVector<Instance> instances;
    PagedVector<Material> materials;
    PagedVector<Texture> textures;
    PagedVector<uint> texels;
    PagedVector<Light> lights;
    PagedVector<Probe> probes;

    std::vector<CameraDesc> cameras; ///< at least one after finishScene
    std::vector<CameraPath> paths;
    std::vector<uint> task_objects; ///< instances that whoever looks at the picture looks for
    std::vector<std::string> instance_names;
    std::vector<std::string> material_names;
    std::string name;                  ///< what the user asked for: a path or builtin:atrium
    std::vector<std::string> warnings; ///< what was missing or ignored, each naming its file
    Bounds bounds;                     ///< world space

    /// Changes whenever anything that a pass may read changed. Never 0 after finishScene; unique in
    /// the process.
    std::uint64_t version = 0;
    /// The version at which anything but the placement of instances last changed.
    std::uint64_t shape_version = 0;

    /// What surrounds it all. Starts a page and is the last member, so that like an array it has
    /// its pages to itself.
    alignas(kPageBytes) Environment environment{};

    /// The camera of that name; the first for "". Throws SceneError that lists the names.
    [[nodiscard]] const CameraDesc& camera(std::string_view camera_name) const;
    [[nodiscard]] std::size_t instancedTriangles() const;
};

/// Checks indices, drops nothing, orders each mesh's triangles into clusters, computes bounds,
/// default camera, default probes (one at the box centre of each of the at most four largest mirror
/// instances, if none was given) and the version. Throws SceneError on an index out of range or
/// more than 2^31 triangles.
void finishScene(Scene& scene);

/// Marks the scene as changed (a moved light, an edited material).
void touch(Scene& scene);

/// Places an instance of a finished scene elsewhere: its matrices, its winding, the scene's bounds
/// (which only grow) and version. Probes stay where they are. Tracers and buffers follow without
/// being made anew; no work that reads the scene may be going on, since they share its arrays.
/// Throws SceneError if a number of the matrix is not finite.
void moveInstance(Scene& scene, uint instance, const mat4x3& to_world);

/// Opens "builtin:NAME", a *.scene.json, or a .gltf / .glb. Throws SceneError (bad content, missing
/// file).
[[nodiscard]] Scene loadScene(const std::string& name);

/// The names that loadScene knows after "builtin:".
[[nodiscard]] std::span<const std::string_view> builtinScenes();

} // namespace hone

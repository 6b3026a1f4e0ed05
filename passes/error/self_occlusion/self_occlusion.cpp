// SPDX-License-Identifier: Apache-2.0
//
// error.self_occlusion: how much of its hemisphere a mirror's own object covers.
//
// For each vertex of a mirror instance, the cosine-weighted share of rays that hit the same
// instance, whatever the distance and whichever face. 0 on convex objects. An instance is a glTF
// primitive placed in the world; instances of one mesh share their vertices, and the first mirror
// among them decides. Vertices of other meshes are 0. Runs again only when the scene changed; where
// that is often, error.screen_occlusion is cheaper and knows less.
//
// in   scene      Scene
// out  occlusion  Occlusion, by vertex of the scene
// params  backend  trace backend
//         rays     rays from each vertex (64); the error is about 0.5 / sqrt(rays) at most
//
//     "occlusion": { "type": "error.self_occlusion", "in": { "scene": "$scene" } }
//
// Source: Amann, Chajdas, Westermann, Error Metrics for Smart Image Refinement, 2012, metric 5.
#include "hone/passes/passes.h"

#include "hone/core/error.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace hone {
namespace {

/// Mixes the bits of x well (Wellons' lowbias32, 2018).
uint hash(uint x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/// [0,1) from the upper 24 bits.
float toUnit(uint bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

uint reverseBits(uint x) {
    uint reversed = 0;
    for (int bit = 0; bit < 32; ++bit)
        reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

/// A scene that holds nothing but the instance. Textures only where its alpha is looked at.
Scene alone(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    Scene result;
    result.positions = scene.positions;
    result.normals = scene.normals;
    result.uvs = scene.uvs;
    const auto first = scene.triangles.begin() + mesh.first_triangle;
    result.triangles.assign(first, first + mesh.triangle_count);
    result.meshes = {{.first_triangle = 0,
                      .triangle_count = mesh.triangle_count,
                      .material = 0,
                      .first_cluster = 0,
                      .cluster_count = 0}};
    result.instances = {instance};
    result.instances[0].mesh = 0;
    result.materials = {scene.materials[mesh.material]};
    if ((result.materials[0].flags & kMaterialMasked) != 0) {
        result.textures = scene.textures;
        result.texels = scene.texels;
    } else {
        result.materials[0].base_color_texture = kNone;
    }
    result.version = scene.version;
    return result;
}

/// The vertices that the triangles use, each once, ascending.
std::vector<uint> usedVertices(std::span<const uvec3> triangles) {
    std::vector<uint> used;
    for (const uvec3& corners : triangles)
        used.insert(used.end(), {corners.x, corners.y, corners.z});
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return used;
}

/// Ray `k` of `count` from a vertex: Hammersley points turned by a hash of the vertex, mapped to
/// the cosine-weighted hemisphere (Malley).
vec3 hemisphereDirection(uint vertex, uint k, uint count, vec3 normal) {
    const float u = std::fmod((static_cast<float>(k) + 0.5f) / static_cast<float>(count) +
                                  toUnit(hash(2 * vertex)),
                              1.0f);
    const float v = std::fmod(toUnit(reverseBits(k)) + toUnit(hash(2 * vertex + 1)), 1.0f);
    const float angle = 2.0f * glm::pi<float>() * u;
    const float radius = std::sqrt(v);
    const vec3 across = std::abs(normal.x) > 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    const vec3 tangent = glm::normalize(glm::cross(normal, across));
    const vec3 bitangent = glm::cross(normal, tangent);
    return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
           std::sqrt(std::max(0.0f, 1.0f - v)) * normal;
}

class SelfOcclusion final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const Scene& scene = *context.scene().scene;
        Value& output = context.out("occlusion");
        output.count = static_cast<uint>(scene.positions.size());
        const std::span<float> occlusion = output.as<float>();
        std::ranges::fill(occlusion, 0.0f);

        std::vector<bool> is_done(scene.meshes.size(), false);
        for (const Instance& instance : scene.instances) {
            const uint flags = scene.materials[scene.meshes[instance.mesh].material].flags;
            if ((flags & kMaterialMirror) == 0 || is_done[instance.mesh])
                continue;
            is_done[instance.mesh] = true;
            const Scene object = alone(scene, instance);
            const std::unique_ptr<TraceBackend> backend =
                context.tracers->make(context.param<std::string>("backend"), object);
            backend->build(object);
            bake(object, *backend, context.param<uint>("rays"), occlusion);
            context.counters->add("rays.self_occlusion", rays_traced_);
        }
    }

private:
    void bake(const Scene& object, const TraceBackend& backend, uint ray_count,
              std::span<float> occlusion) {
        const Instance& instance = object.instances[0];
        const std::vector<uint> vertices = usedVertices(object.triangles);
        rays_traced_ = std::uint64_t{ray_count} * vertices.size();

        // Trace the rays of some thousand vertices at a time.
        for (std::size_t begin = 0; begin < vertices.size(); begin += kBatch) {
            const std::size_t end = std::min(begin + kBatch, vertices.size());
            rays_.clear();
            for (std::size_t i = begin; i < end; ++i) {
                const uint vertex = vertices[i];
                const vec3 normal = glm::normalize(instance.normal_matrix * object.normals[vertex]);
                const vec3 position = instance.to_world * vec4(object.positions[vertex], 1.0f);
                // Off the surface as offsetOrigin() does: as coarse as floats are there.
                const vec3 size = glm::abs(position);
                const float offset = 1e-5f + 1e-5f * std::max({size.x, size.y, size.z});
                for (uint k = 0; k < ray_count; ++k)
                    rays_.push_back({position + offset * normal, 0.0f,
                                     hemisphereDirection(vertex, k, ray_count, normal), 1e30f});
            }
            blocked_.resize(rays_.size());
            backend.occluded(rays_, blocked_, Coherence::kIncoherent, {});
            for (std::size_t i = begin; i < end; ++i) {
                const std::span<const uint> own =
                    std::span<const uint>(blocked_).subspan((i - begin) * ray_count, ray_count);
                occlusion[vertices[i]] =
                    static_cast<float>(std::ranges::count(own, 1u)) / static_cast<float>(ray_count);
            }
        }
    }

    static constexpr std::size_t kBatch = 1024; ///< vertices

    std::vector<Ray> rays_;
    std::vector<uint> blocked_;
    std::uint64_t rays_traced_ = 0;
};

} // namespace

PassType selfOcclusionPass() {
    return PassType("error.self_occlusion",
                    "How much of its hemisphere a mirror's own object covers, by vertex")
        .in("scene", types::kScene, "the mirrors")
        .out("occlusion", types::kOcclusion, "0 for vertices of what is no mirror",
             [](const SizeQuery& query) { return query.scene->positions.size(); })
        .backendParam("backend", "what traces the rays")
        .param("rays", 64u, {.min = 1, .max = 65536}, "from each vertex")
        .implementedBy<SelfOcclusion>(Domain::kHost);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/gltf_materials.h"

#include "hone/core/error.h"
#include "hone/core/image/decode.h"
#include "hone/core/printable.h"
#include "hone/core/scene/mipmap.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <thread>
#include <tuple>

namespace hone {
namespace {

constexpr double kMirrorRoughness = 0.1;
constexpr double kBlendCutoff = 0.5;

/// An image as the scene will hold it, or why not.
struct LoadedImage {
    uvec2 extent{0, 0};
    std::vector<uint> texels; ///< all levels
    bool has_holes = false;   ///< some alpha is below 1
    std::string problem;
};

LoadedImage loadImage(const GltfFile& file, std::size_t index) {
    LoadedImage loaded;
    try {
        const Image8 image = decodeImage(file.readImage(index), file.images[index].name);
        loaded.extent = image.extent;
        for (std::size_t i = 3; i < image.rgba.size() && !loaded.has_holes; i += 4)
            loaded.has_holes = image.rgba[i] != 255;
        loaded.texels = makeMipmap(image.extent, image.rgba);
    } catch (const InputError& error) {
        loaded.problem = error.what();
    } catch (const SceneError& error) {
        loaded.problem = error.what();
    }
    return loaded;
}

/// The textures of the materials, decoded on all cores, appended in the order of first use.
class Textures {
public:
    Textures(const GltfFile& file, Scene& scene, GltfWarnings& warnings)
        : file_(file), scene_(scene), warnings_(warnings), images_(file.images.size()),
          first_texel_(file.images.size(), kNone) {
        std::vector<std::size_t> used;
        for (const tinygltf::Material& material : file.model.materials)
            if (const int image = imageOf(material); image >= 0)
                used.push_back(static_cast<std::size_t>(image));
        std::ranges::sort(used);
        used.erase(std::unique(used.begin(), used.end()), used.end());

        std::atomic<std::size_t> next{0};
        auto work = [&] {
            for (std::size_t i = next++; i < used.size(); i = next++)
                images_[used[i]] = loadImage(file, used[i]);
        };
        std::vector<std::jthread> threads;
        const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
        for (std::size_t i = 1; i < std::min(cores, used.size()); ++i)
            threads.emplace_back(work);
        work();
    }

    /// The scene's texture for a material's base colour, or kNone.
    uint baseColor(const tinygltf::Material& material, const std::string& material_name) {
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        if (texture < 0)
            return kNone;
        const int image = imageOf(material);
        if (image < 0) {
            warnings_.add("a base colour texture has no image and is left out", material_name);
            return kNone;
        }
        const auto index = static_cast<std::size_t>(image);
        if (!images_[index].problem.empty()) {
            // Decoders already name the image in their own words.
            const std::string& name = file_.images[index].name;
            const bool names_itself = images_[index].problem.find(name) != std::string::npos;
            warnings_.add((names_itself ? "" : name + ": ") + images_[index].problem +
                              "; used without its texture",
                          material_name);
            return kNone;
        }
        return find(index, file_.model.textures[static_cast<std::size_t>(texture)]);
    }

    [[nodiscard]] bool hasHoles(const tinygltf::Material& material) const {
        const int image = imageOf(material);
        return image >= 0 && images_[static_cast<std::size_t>(image)].has_holes;
    }

private:
    [[nodiscard]] int imageOf(const tinygltf::Material& material) const {
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        if (texture < 0 || static_cast<std::size_t>(texture) >= file_.model.textures.size())
            return -1;
        const int image = file_.model.textures[static_cast<std::size_t>(texture)].source;
        return static_cast<std::size_t>(image) < file_.images.size() ? image : -1;
    }

    static uint wrapMode(int gltf_mode) {
        return gltf_mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? 1
               : gltf_mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? 2
                                                                    : 0;
    }

    uint find(std::size_t image, const tinygltf::Texture& texture) {
        uint wrap_u = 0;
        uint wrap_v = 0;
        if (static_cast<std::size_t>(texture.sampler) < file_.model.samplers.size()) {
            const auto& sampler = file_.model.samplers[static_cast<std::size_t>(texture.sampler)];
            wrap_u = wrapMode(sampler.wrapS);
            wrap_v = wrapMode(sampler.wrapT);
        }
        const auto [found, is_new] = textures_.try_emplace(
            std::tuple(image, wrap_u, wrap_v), static_cast<uint>(scene_.textures.size()));
        if (is_new) {
            const uvec2 extent = images_[image].extent;
            scene_.textures.push_back(
                {appendTexels(image), extent.x, extent.y, mipLevels(extent), wrap_u, wrap_v});
        }
        return found->second;
    }

    uint appendTexels(std::size_t image) {
        if (first_texel_[image] != kNone)
            return first_texel_[image];
        std::vector<uint>& texels = images_[image].texels;
        if (texels.size() > std::numeric_limits<uint>::max() - scene_.texels.size())
            file_.fail("/images/" + std::to_string(image),
                       "the textures have more than 2^32 texels together");
        first_texel_[image] = static_cast<uint>(scene_.texels.size());
        scene_.texels.insert(scene_.texels.end(), texels.begin(), texels.end());
        texels = {};
        return first_texel_[image];
    }

    const GltfFile& file_;
    Scene& scene_;
    GltfWarnings& warnings_;
    std::vector<LoadedImage> images_;
    std::vector<uint> first_texel_;
    std::map<std::tuple<std::size_t, uint, uint>, uint> textures_;
};

float unit(double value) {
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

/// A number in one of the material's extensions.
double extensionNumber(const tinygltf::Material& material, const char* extension, const char* key,
                       double fallback) {
    const auto found = material.extensions.find(extension);
    if (found == material.extensions.end() || !found->second.IsObject() ||
        !found->second.Has(key) || !found->second.Get(key).IsNumber())
        return fallback;
    return found->second.Get(key).GetNumberAsDouble();
}

vec3 emissionOf(const tinygltf::Material& material, const std::string& name,
                GltfWarnings& warnings) {
    if (material.emissiveTexture.index >= 0) {
        warnings.add("emissive textures are not supported; the material does not emit", name);
        return vec3(0.0f);
    }
    const double strength =
        extensionNumber(material, "KHR_materials_emissive_strength", "emissiveStrength", 1.0);
    vec3 emission(0.0f);
    if (material.emissiveFactor.size() != 3)
        return emission;
    for (int c = 0; c < 3; ++c)
        emission[c] = static_cast<float>(
            std::clamp(material.emissiveFactor[static_cast<std::size_t>(c)] * strength, 0.0, 1e30));
    return emission;
}

/// Mirror or diffuse, as the header says. Expects base_color.
void setReflection(Material& made, const tinygltf::Material& material) {
    const auto& pbr = material.pbrMetallicRoughness;
    if (pbr.roughnessFactor > kMirrorRoughness || pbr.metallicRoughnessTexture.index >= 0)
        return;
    const double ior = std::max(extensionNumber(material, "KHR_materials_ior", "ior", 1.5), 1.0);
    const double dielectric = (ior - 1.0) / (ior + 1.0) * ((ior - 1.0) / (ior + 1.0));
    const float metallic = unit(pbr.metallicFactor);
    made.flags |= kMaterialMirror;
    made.f0 = glm::mix(vec3(static_cast<float>(dielectric)), made.base_color, metallic);
    made.base_color *= 1.0f - metallic;
}

void setAlpha(Material& made, const tinygltf::Material& material, bool has_holes,
              const std::string& name, GltfWarnings& warnings) {
    if (material.alphaMode == "BLEND")
        warnings.add("alphaMode BLEND is drawn as MASK with a cutoff of 0.5", name);
    else if (material.alphaMode != "MASK")
        return;
    made.alpha_cutoff = material.alphaMode == "BLEND" ? static_cast<float>(kBlendCutoff)
                                                      : unit(material.alphaCutoff);
    // Without holes the test would cost time and change nothing.
    if (has_holes || made.alpha < made.alpha_cutoff)
        made.flags |= kMaterialMasked;
}

Material convert(const tinygltf::Material& material, const std::string& name, Textures& textures,
                 GltfWarnings& warnings) {
    const auto& pbr = material.pbrMetallicRoughness;
    Material made{};
    made.base_color = vec3(unit(pbr.baseColorFactor[0]), unit(pbr.baseColorFactor[1]),
                           unit(pbr.baseColorFactor[2]));
    made.alpha = unit(pbr.baseColorFactor[3]);
    made.base_color_texture = textures.baseColor(material, name);
    made.emission = emissionOf(material, name, warnings);
    if (material.doubleSided)
        made.flags |= kMaterialTwoSided;
    setReflection(made, material);
    setAlpha(made, material, textures.hasHoles(material), name, warnings);
    if (material.extensions.contains("KHR_materials_transmission"))
        warnings.add("KHR_materials_transmission is ignored; the material is opaque", name);
    if (pbr.baseColorTexture.extensions.contains("KHR_texture_transform"))
        warnings.add("KHR_texture_transform is ignored", name);
    return made;
}

} // namespace

void appendGltfMaterials(const GltfFile& file, Scene& scene, GltfWarnings& warnings) {
    Textures textures(file, scene, warnings);
    for (std::size_t i = 0; i < file.model.materials.size(); ++i) {
        const tinygltf::Material& material = file.model.materials[i];
        const std::string name =
            material.name.empty() ? "material " + std::to_string(i) : printable(material.name);
        scene.materials.push_back(convert(material, name, textures, warnings));
        scene.material_names.push_back(name);
    }
    const bool needs_default = std::ranges::any_of(file.model.meshes, [](const auto& mesh) {
        return std::ranges::any_of(mesh.primitives, [](const auto& p) { return p.material < 0; });
    });
    if (needs_default) {
        scene.materials.push_back(convert(tinygltf::Material(), "default", textures, warnings));
        scene.material_names.emplace_back("default");
    }
}

} // namespace hone

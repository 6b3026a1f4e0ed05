// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/explain_images.h"

#include "hone/cli/pixel_probe.h"
#include "hone/core/error.h"
#include "hone/core/image/exr.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// What hone render wrote into an image about how it was made.
class Origin {
public:
    explicit Origin(const std::string& path) : path_(path) {
        const std::vector<std::byte> bytes = readFile(path);
        if (isExr(bytes))
            attributes_ = decodeExr(bytes, path).attributes;
    }

    /// Throws InputError if the image does not say.
    [[nodiscard]] const std::string& get(std::string_view name) const {
        for (const auto& [attribute, text] : attributes_)
            if (attribute == name)
                return text;
        throw InputError(path_ + ": does not say " + std::string(name) +
                         "; only EXR images by hone render can be explained");
    }

private:
    std::string path_;
    std::vector<std::pair<std::string, std::string>> attributes_;
};

std::uint64_t toNumber(const std::string& text) {
    std::uint64_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

/// How both images were made, which must be the same but for the backend.
PixelProbe::Setup commonOrigin(const Origin& a, const Origin& b, uvec2 extent) {
    for (const char* name : {"hone.graph", "hone.scene", "hone.camera", "hone.path", "hone.time",
                             "hone.seed", "hone.version"})
        if (a.get(name) != b.get(name))
            throw InputError("the images differ in " + std::string(name) +
                             "; only images that differ in their backend alone can be explained");
    PixelProbe::Setup setup;
    setup.graph = a.get("hone.graph");
    setup.scene = a.get("hone.scene");
    setup.camera = a.get("hone.camera");
    setup.path = a.get("hone.path");
    const std::string time = a.get("hone.time");
    std::from_chars(time.data(), time.data() + time.size(), setup.time);
    setup.extent = extent;
    setup.seed = toNumber(a.get("hone.seed"));
    setup.backends[0] = a.get("hone.backend");
    setup.backends[1] = b.get("hone.backend");
    std::istringstream lines(a.get("hone.parameters"));
    for (std::string line; std::getline(lines, line);)
        if (const std::size_t equals = line.find('='); equals != std::string::npos)
            setup.overrides.emplace_back(line.substr(0, equals), line.substr(equals + 1));
    return setup;
}

Json describe(const std::optional<PixelReason>& reason) {
    if (!reason)
        return {{"why", name(DifferenceKind::kUnexplained)}};
    Json pixel{{"why", name(reason->difference.kind)},
               {"ray_kind", reason->kind},
               {"ray", toText(reason->ray)},
               {"a", reason->answers[0]},
               {"b", reason->answers[1]}};
    if (reason->difference.border != Border::kNone)
        pixel["border"] = name(reason->difference.border);
    return pixel;
}

} // namespace

Json explainImages(const std::string& path_a, const RgbImage& a, const std::string& path_b,
                   const RgbImage& b, std::span<const std::string> plugins) {
    PixelProbe::Setup setup = commonOrigin(Origin(path_a), Origin(path_b), a.extent);
    setup.plugins.assign(plugins.begin(), plugins.end());
    PixelProbe probe(setup);
    Json pixels = Json::array();
    std::size_t counts[4] = {};
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(vec3)) == 0)
            continue;
        const std::optional<PixelReason> reason = probe.ask(static_cast<uint>(i));
        const DifferenceKind kind = reason ? reason->difference.kind : DifferenceKind::kUnexplained;
        ++counts[static_cast<std::size_t>(kind)];
        Json pixel{{"x", i % a.extent.x}, {"y", i / a.extent.x}};
        pixel.update(describe(reason));
        pixels.push_back(std::move(pixel));
    }
    const auto count = [&](DifferenceKind kind) { return counts[static_cast<std::size_t>(kind)]; };
    return {{"ties", count(DifferenceKind::kTie)},
            {"silhouettes", count(DifferenceKind::kSilhouette)},
            {"unexplained", count(DifferenceKind::kUnexplained)},
            {"pixels", std::move(pixels)}};
}

} // namespace hone::cli

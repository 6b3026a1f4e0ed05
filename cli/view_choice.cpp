// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/view_choice.h"

#include "hone/cli/commands.h"
#include "hone/core/error.h"
#include "hone/core/graph/executor.h"
#include "hone/passes/sort/error_key.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace hone::cli {
namespace {

constexpr std::size_t kCandidates = 256;
constexpr uvec2 kSmall{160, 120};
/// A view must show something in at least this part of its pixels, and not only what is right
/// before the lens: half of what it sees is farther away than this part of the scene's radius.
constexpr double kSeen = 0.7;
constexpr float kNotBefore = 0.03f;

/// The index-th number of the van der Corput sequence in a base: fills [0,1) evenly (Halton 1960).
double radicalInverse(std::size_t index, std::size_t base) {
    double result = 0, digit = 1.0 / static_cast<double>(base);
    for (; index > 0; index /= base, digit /= static_cast<double>(base))
        result += digit * static_cast<double>(index % base);
    return result;
}

float between(double low, double high, double part) {
    return static_cast<float>(low + (high - low) * part);
}

/// Centre and radius of an instance in the world.
std::pair<vec3, float> sphereOf(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    Bounds bounds;
    for (const uvec3& corners :
         std::span(scene.triangles).subspan(mesh.first_triangle, mesh.triangle_count))
        for (int corner = 0; corner < 3; ++corner)
            bounds.add(instance.to_world * vec4(scene.positions[corners[corner]], 1.0f));
    return {bounds.center(), glm::distance(bounds.high, bounds.center())};
}

std::vector<std::pair<vec3, float>> mirrorsOf(const Scene& scene) {
    std::vector<std::pair<vec3, float>> mirrors;
    for (const Instance& instance : scene.instances)
        if (instance.probe != kNone)
            mirrors.push_back(sphereOf(scene, instance));
    return mirrors;
}

/// The graph with nothing asked for but how wrong its pixels are, so that nothing is traced.
CompiledGraph compileErrors(const std::string& path, const Catalog& catalog) {
    std::vector<Diagnostic> diagnostics;
    GraphDesc desc = parseGraphFile(path, diagnostics, catalog.graphs);
    const auto is_error = [](const OutputDesc& output) { return output.name.text == "error"; };
    if (desc.is_readable && std::ranges::none_of(desc.outputs, is_error))
        throw GraphError(path + ": cannot choose views by it: it has no output \"error\"");
    std::erase_if(desc.outputs, std::not_fn(is_error));
    CompiledGraph graph = compileOrThrow(desc, catalog, {}, std::move(diagnostics));
    const PlannedValue& error = graph.values[graph.outputs.front().value];
    if (!(error.type == types::kError))
        throw GraphError(path + ": cannot choose views by it: its output \"error\" is " +
                         std::string(error.type.name) + ", no Error");
    return graph;
}

bool seesEnough(std::span<const float> depth, float radius) {
    const auto seen = std::ranges::count_if(depth, [](float z) { return z > 0; });
    const auto far = std::ranges::count_if(depth, [&](float z) { return z > kNotBefore * radius; });
    return static_cast<double>(seen) >= kSeen * static_cast<double>(depth.size()) &&
           2 * far >= static_cast<std::ptrdiff_t>(depth.size());
}

} // namespace

std::vector<CameraDesc> candidateViews(const Scene& scene, const CameraDesc& like,
                                       std::size_t count) {
    const std::vector<std::pair<vec3, float>> mirrors = mirrorsOf(scene);
    const vec3 low = scene.bounds.low, size = scene.bounds.high - low;
    std::vector<CameraDesc> views;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = radicalInverse(i + 1, 2), b = radicalInverse(i + 1, 3),
                     c = radicalInverse(i + 1, 5), d = radicalInverse(i + 1, 7);
        CameraDesc view = like;
        view.name = "view " + std::to_string(i);
        view.up = vec3(0, 1, 0);
        const float yaw = between(0, 2 * std::numbers::pi, a);
        if (i % 2 == 0 && !mirrors.empty()) {
            const auto& [center, radius] = mirrors[(i / 2) % mirrors.size()];
            const float height = between(-0.05, 0.6, b);
            const vec3 towards = glm::normalize(vec3(std::cos(yaw), height, std::sin(yaw)));
            view.position =
                center + radius * std::pow(16.0f, static_cast<float>(c)) * 1.2f * towards;
            view.target = center;
        } else {
            const vec3 place(between(0.1, 0.9, b), between(0.05, 0.6, c), between(0.1, 0.9, d));
            const float pitch = between(-0.4, 0.2, radicalInverse(i + 1, 11));
            view.position = low + place * size;
            view.target = view.position + vec3(std::cos(yaw), pitch, std::sin(yaw));
        }
        views.push_back(view);
    }
    return views;
}

std::vector<ChosenView> chooseViewsByShare(const std::string& graph_path, const Session& session,
                                           const Devices& devices, const Scene& scene,
                                           const CameraDesc& like, std::span<const double> shares) {
    const Catalog catalog = session.catalog();
    Executor errors(compileErrors(graph_path, catalog), catalog, devices);
    Executor raster(loadGraph(findGraph("raster"), catalog, {}), catalog, devices);
    for (Executor* executor : {&errors, &raster}) {
        executor->setScene(scene);
        executor->setExtent(kSmall);
    }
    const float radius = glm::distance(scene.bounds.high, scene.bounds.center());

    std::vector<ChosenView> seen;
    for (const CameraDesc& view : candidateViews(scene, like, kCandidates)) {
        raster.setCamera(makeCamera(view));
        raster.run();
        if (!seesEnough(raster.output("depth").as<float>(), radius))
            continue;
        errors.setCamera(makeCamera(view));
        errors.run();
        const auto wrong = std::ranges::count_if(errors.output("error").as<vec2>(), isErrorPixel);
        seen.push_back({view, 0, static_cast<double>(wrong) / (kSmall.x * kSmall.y)});
    }
    if (seen.size() < shares.size())
        throw SceneError(scene.name + ": only " + std::to_string(seen.size()) + " of " +
                         std::to_string(kCandidates) +
                         " places tried see enough of the scene to choose views from");

    // Shares differ by factors, so the nearest is by ratio.
    std::vector<ChosenView> chosen;
    for (const double share : shares) {
        const auto distance = [&](const ChosenView& view) {
            return std::abs(std::log((view.share + 1e-4) / (share + 1e-4)));
        };
        const auto best = std::ranges::min_element(seen, {}, distance);
        chosen.push_back(*best);
        chosen.back().wanted_share = share;
        seen.erase(best);
    }
    return chosen;
}

} // namespace hone::cli

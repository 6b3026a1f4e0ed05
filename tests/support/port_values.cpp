// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/port_values.h"

#include "hone/backends/embree/embree_backend.h"
#include "hone/core/image/tile_order.h"
#include "hone/core/trace/ray.glsl.h"
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <sstream>
#include <tuple>

namespace hone::test {
namespace {

constexpr float kMost = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNothing = 1e30f; ///< the depth of what maps do not see
constexpr uint kProbeSize = 8;    ///< texels along an edge of generated environment maps

/// Elements of one port, made in order.
class Generator {
public:
    Generator(const PortType& type, std::string_view name, const Frame& frame, uint turn)
        : type_(&type), frame_(&frame),
          random_(std::hash<std::string_view>()(name) + frame.seed * 977u + turn) {}

    uint below(uint end) { return static_cast<uint>(random_()) % end; }

    float number() { return number(least(), type_->max); }
    float number(float low, float high) {
        const float tame_high = std::min(high, low + 2);
        const float some = low + (tame_high - low) * static_cast<float>(below(1001)) / 1000;
        switch (frame_->content) {
        case Content::kZeros:
            return std::clamp(0.0f, low, high);
        case Content::kRandom:
            return below(8) == 0 ? std::clamp(0.0f, low, high) : some;
        case Content::kExtremes: {
            const float all[] = {low,
                                 std::min(high, kMost),
                                 frame_->has_tiny ? std::numeric_limits<float>::min() : 1e-6f,
                                 frame_->has_tiny ? std::numeric_limits<float>::denorm_min() : 0.0f,
                                 -0.0f,
                                 some,
                                 1e-6f,
                                 1};
            return std::clamp(all[below(std::size(all))], low, high);
        }
        case Content::kHostile:
            break;
        }
        const float all[] = {std::numeric_limits<float>::quiet_NaN(),
                             kInfinity,
                             -kInfinity,
                             -1,
                             -kMost,
                             kMost,
                             0,
                             some};
        return all[below(std::size(all))];
    }
    /// Of things that are counted.
    uint whole(uint low, uint everyday) {
        switch (frame_->content) {
        case Content::kZeros:
            return low;
        case Content::kRandom:
            return low + below(everyday);
        default:
            return below(2) == 0 ? low : std::numeric_limits<uint>::max();
        }
    }
    void shuffle(std::vector<uint>& items) { std::ranges::shuffle(items, random_); }

private:
    /// A tolerance must not be 0.
    [[nodiscard]] float least() const {
        const float least = std::isfinite(type_->min) ? type_->min : 0.0f;
        return *type_ == types::kTolerance ? std::max(least, 1e-6f) : least;
    }

    const PortType* type_;
    const Frame* frame_;
    std::mt19937 random_;
};

/// The pixels that a list of requests names, in tile order: none, every third and its neighbour,
/// all.
std::vector<uint> requestedPixels(const Frame& frame) {
    const TileOrder tiles(frame.extent);
    std::vector<uint> pixels;
    for (uint tile = 0; tile < tiles.tiles().x * tiles.tiles().y; ++tile)
        tiles.forEachPixel(tile, [&](uint pixel) {
            if (frame.fill == Fill::kFull || (frame.fill == Fill::kSome && pixel % 3 != 1))
                pixels.push_back(pixel);
        });
    return pixels;
}

/// Elements of a record as its pass would make it of these parameters.
std::size_t recordSize(const PassType& maker, std::string_view port, const Frame& frame,
                       const std::map<std::string_view, uint>& chosen) {
    PassParams params(maker);
    for (const auto& [name, value] : chosen)
        params.set(name, value);
    return maker.findOut(port)->size(
        {frame.extent, params, frame.scene, [](std::string_view) { return std::size_t{0}; }});
}

/// The header is always that of the scene; depths are positive.
std::vector<float> shadowMaps(Generator& generator, const Frame& frame) {
    constexpr std::size_t kHeader = 8;
    constexpr uint kPoints = 5;
    std::vector<float> maps(
        recordSize(shadowMapPass(), "maps", frame, {{"size", kMapSize}, {"points", kPoints}}));
    const Bounds& bounds = frame.scene->bounds;
    const vec3 center = bounds.empty() ? vec3(0) : bounds.center();
    const float radius =
        bounds.empty() ? 1.0f : std::max(glm::distance(bounds.high, center), 1e-6f);
    const float header[kHeader] = {kMapSize, kPoints, center.x, center.y, center.z, radius, 0, 0};
    for (std::size_t i = 0; i < maps.size(); ++i)
        maps[i] = i < kHeader                        ? header[i]
                  : frame.content == Content::kZeros ? kNothing
                  : generator.below(8) == 0          ? kNothing
                                                     : generator.number(1e-4f, radius * 2);
    return maps;
}

std::vector<vec4> environmentMaps(Generator& generator, const Frame& frame) {
    std::vector<vec4> maps(
        recordSize(environmentProbePass(), "maps", frame, {{"size", kProbeSize}}));
    for (vec4& texel : maps)
        texel = {generator.number(0, kMost), generator.number(0, kMost), generator.number(0, kMost),
                 generator.number(1e-4f, kNothing)};
    maps[0] = vec4(kProbeSize, static_cast<float>(frame.scene->probes.size()), 0, 0);
    return maps;
}

std::vector<uvec2> shadowRanges(const Frame& frame) {
    Generator of_maps(types::kShadowMaps, types::kShadowMaps.name, frame, 0);
    PassRun run(shadowRangePass());
    run.extent(frame.extent).scene(*frame.scene).param("size", kMapSize);
    run.list("shadow_maps", shadowMaps(of_maps, frame)).execute();
    return run.output<uvec2>("ranges");
}

/// What the pixels' centres see, and nothing anywhere where all is to be zero.
std::vector<Hit> hits(const Frame& frame) {
    if (frame.content == Content::kZeros)
        return std::vector<Hit>(frame.pixels(), Hit{kNone, kNone});
    TraceBackendRegistry embree;
    embree.add("embree", "Embree", [](const Devices&) { return makeEmbreeBackend(); });
    PassRun run(rasterPass());
    run.extent(frame.extent).scene(*frame.scene).camera(frame.camera).tracers(embree);
    run.param("visibility", "rays").param("backend", "embree").execute();
    return run.output<Hit>("gbuffer");
}

template <class T> std::vector<std::byte> toBytes(const std::vector<T>& elements) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(elements));
    return {bytes.begin(), bytes.end()};
}

/// Elements of a plane or record of plain floats.
std::vector<std::byte> numbers(Generator& generator, const PortType& type, std::size_t elements) {
    std::vector<float> values(elements * type.stride / sizeof(float));
    for (float& value : values)
        value = generator.number();
    return toBytes(values);
}

/// Infinities and NaN stay; nothing becomes infinite.
void raiseSome(Generator& generator, std::vector<std::byte>& numbers) {
    for (std::size_t at = 0; at < numbers.size(); at += sizeof(float)) {
        float number = 0;
        std::memcpy(&number, &numbers[at], sizeof(float));
        if (!std::isfinite(number) || generator.below(2) == 0)
            continue;
        number = std::min(number + 0.5f * std::abs(number) + 0.1f, kMost);
        std::memcpy(&numbers[at], &number, sizeof(float));
    }
}

template <class T, class Make> std::vector<std::byte> many(std::size_t count, Make make) {
    std::vector<T> elements(count);
    std::ranges::generate(elements, make);
    return toBytes(elements);
}

std::vector<std::byte> elementsOf(const PortType& type, std::string_view name, const Frame& frame,
                                  uint turn) {
    Generator generator(type, name, frame, turn);
    const uint pixels = frame.pixels();
    const std::vector<uint> requested = requestedPixels(frame);
    if (type == types::kHits)
        return toBytes(hits(frame));
    if (type == types::kShadowMaps)
        return toBytes(shadowMaps(generator, frame));
    if (type == types::kShadowRanges)
        return toBytes(shadowRanges(frame));
    if (type == types::kEnvironmentMaps)
        return toBytes(environmentMaps(generator, frame));
    if (type == types::kOcclusion)
        return numbers(generator, type, frame.scene->positions.size());
    if (type == types::kAccumulation)
        return many<Accumulated>(pixels, [&] {
            const vec3 sum(generator.number(0, kMost), generator.number(0, kMost),
                           generator.number(0, kMost));
            return Accumulated{sum, generator.whole(0, 4)};
        });
    if (type == types::kRound)
        return many<uint>(pixels, [&] { return generator.whole(0, 4); });
    if (type == types::kSampleCounts)
        return many<uint>(pixels, [&] { return generator.whole(1, 8); });
    if (type == types::kCursor)
        return many<uint>(1, [&] { return generator.whole(0, 4); });
    if (type == types::kPixelList) {
        std::vector<uint> order(pixels);
        std::iota(order.begin(), order.end(), 0u);
        generator.shuffle(order);
        order.resize(requested.size());
        return toBytes(order);
    }
    if (type == types::kRequestList)
        return many<uvec3>(requested.size(),
                           [&, i = 0u]() mutable { return uvec3(requested[i++], 0, 1); });
    if (type == types::kSamples)
        return many<Sample>(requested.size() * 2, [&, i = 0u]() mutable {
            const vec3 radiance(generator.number(0, kMost), generator.number(0, kMost),
                                generator.number(0, kMost));
            return Sample{radiance, requested[i++ / 2]};
        });
    const bool is_float = type.format == "float" || type.format.starts_with("vec");
    HONE_ASSERT(is_float, "no content is known for type " + std::string(type.name));
    std::vector<std::byte> made =
        numbers(generator, type, type.shape == Shape::kPlane ? pixels : 1);
    if (type == types::kError && frame.has_greater_errors)
        raiseSome(generator, made);
    return made;
}

/// What is wrong with a list of things that name pixels.
std::string problemOfPixels(const std::vector<uint>& pixels, const Frame& frame, bool in_order) {
    const TileOrder tiles(frame.extent);
    std::vector<bool> is_named(frame.pixels(), false);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::string where = "element " + std::to_string(i) + " names pixel ";
        if (pixels[i] >= frame.pixels())
            return where + std::to_string(pixels[i]) + " of " + std::to_string(frame.pixels());
        if (is_named[pixels[i]])
            return where + std::to_string(pixels[i]) + " a second time";
        is_named[pixels[i]] = true;
        if (in_order && i > 0 && tiles.key(pixels[i]) < tiles.key(pixels[i - 1]))
            return where + std::to_string(pixels[i]) + ", against tile order";
    }
    return "";
}

/// Of the first `floats` numbers of each element.
std::string problemOfNumbers(const Value& value, std::size_t floats, float low, float high,
                             bool is_strict) {
    const std::size_t stride = value.type->stride / sizeof(float);
    const std::span<const float> all = value.buffer.as<float>().first(value.count * stride);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool is_in_range = all[i] >= low && all[i] <= high;
        if (i % stride >= floats || (is_strict ? is_in_range && std::isfinite(all[i])
                                               : is_in_range || !std::isfinite(all[i])))
            continue;
        std::ostringstream text;
        text << "number " << i % stride << " of element " << i / stride << " is " << all[i];
        return text.str();
    }
    return "";
}

std::string problemOfHits(const Value& value, const Scene& scene) {
    for (const Hit& hit : value.as<Hit>()) {
        if (hit.instance == kNone && hit.primitive == kNone)
            continue;
        if (hit.instance >= scene.instances.size() ||
            hit.primitive >= scene.meshes[scene.instances[hit.instance].mesh].triangle_count)
            return "a hit is no triangle: (" + std::to_string(hit.instance) + ", " +
                   std::to_string(hit.primitive) + ")";
    }
    return "";
}

/// Kept, for many cases have the same inputs.
const std::vector<std::byte>& keptElementsOf(const InPort& port, const Frame& frame, uint turn) {
    using Key = std::tuple<std::string, std::string_view, uint, std::uint64_t, uint, uint, Content,
                           Fill, uint, bool, bool, bool, float>;
    static std::map<Key, std::vector<std::byte>> kept;
    const PortType& type = port.type;
    const std::string name(type.shape == Shape::kRecord ? std::string(type.name) : port.name);
    const Key key{name,
                  type.name,
                  turn,
                  frame.scene->version,
                  frame.extent.x,
                  frame.extent.y,
                  frame.content,
                  frame.fill,
                  frame.seed,
                  frame.has_tiny,
                  frame.has_greater_errors,
                  frame.is_reversed,
                  frame.camera.lens_radius};
    if (const auto found = kept.find(key); found != kept.end())
        return found->second;
    std::vector<std::byte> made = elementsOf(type, name, frame, turn);
    if (frame.is_reversed && type.shape == Shape::kPlane)
        made = reversed(made, type.stride);
    return kept.emplace(key, std::move(made)).first->second;
}

} // namespace

std::vector<std::byte> reversed(std::span<const std::byte> elements, std::size_t stride) {
    std::vector<std::byte> result;
    for (std::size_t end = elements.size(); end > 0; end -= stride)
        result.insert(result.end(), elements.begin() + static_cast<std::ptrdiff_t>(end - stride),
                      elements.begin() + static_cast<std::ptrdiff_t>(end));
    return result;
}

void feedPort(PassRun& run, const InPort& port, const Frame& frame, uint turn) {
    const std::vector<std::byte>& elements = keptElementsOf(port, frame, turn);
    std::vector<ParamValue> edge_params;
    if (turn > 0) // the first edge has the defaults
        for (const ParamDecl& decl : port.edge_params)
            edge_params.push_back(decl.type == ParamType::kFloat
                                      ? ParamValue(0.25f * static_cast<float>(turn))
                                      : decl.fallback);
    // Lists have room for more than they hold, but where they are full.
    const bool has_room = port.type.shape == Shape::kList && frame.fill != Fill::kFull;
    run.bytes(port.name, elements, elements.size() / port.type.stride + (has_room ? 3 : 0),
              std::move(edge_params));
}

std::string problemOf(const Value& value, const Frame& frame) {
    const PortType& type = *value.type;
    if (value.count > value.buffer.bytes / type.stride)
        return std::to_string(value.count) + " elements are more than fit";
    if (type.shape == Shape::kPlane && value.count != frame.pixels())
        return std::to_string(value.count) + " elements are not one a pixel";
    if (type == types::kHits)
        return problemOfHits(value, *frame.scene);
    std::vector<uint> pixels;
    if (type == types::kPixelList) {
        for (uint pixel : value.as<uint>())
            pixels.push_back(pixel);
        return problemOfPixels(pixels, frame, false);
    }
    if (type == types::kRequestList) {
        for (const uvec3& request : value.as<uvec3>()) {
            if (request.z == 0)
                return "a request asks for no samples";
            pixels.push_back(request.x);
        }
        return problemOfPixels(pixels, frame, true);
    }
    if (type == types::kSamples) {
        for (const Sample& sample : value.as<Sample>())
            if (pixels.empty() || pixels.back() != sample.pixel)
                pixels.push_back(sample.pixel);
        if (const std::string problem = problemOfPixels(pixels, frame, true); !problem.empty())
            return problem;
    }
    if (type == types::kSampleCounts && std::ranges::count(value.as<uint>(), 0u) > 0)
        return "a count is 0";

    const bool is_tame = frame.content == Content::kZeros || frame.content == Content::kRandom;
    if (type == types::kSamples || type == types::kAccumulation)
        return is_tame ? problemOfNumbers(value, 3, 0, kMost, true) : "";
    if (type.format != "float" && !type.format.starts_with("vec"))
        return "";
    const bool is_strict =
        is_tame || type == types::kError || type == types::kTolerance || std::isfinite(type.max);
    if (!is_strict && frame.content == Content::kHostile)
        return "";
    const float low =
        type == types::kTolerance ? std::numeric_limits<float>::denorm_min() : type.min;
    return problemOfNumbers(value, type.stride, low, type.max, is_strict);
}

} // namespace hone::test

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace hone {

/// How the elements of a value are laid out.
enum class Shape : std::uint8_t {
    kPlane,  ///< width x height elements, row major, top row first; index y * width + x
    kList,   ///< up to a capacity of elements; Value::count of them are valid
    kRecord, ///< a fixed number of elements that the pass decides (a cursor, a histogram)
    kScene,  ///< a Scene and its buffers
    kCamera, ///< a Camera
    kExtent, ///< width and height in pixels
    kCurve,  ///< a loop's statistics, one entry an iteration (host only)
};

/// What a value means. Ports connect only when their types are the same; the meaning is what
/// counts, not the bytes: depth never goes into error. Identity is the name; plug-ins may add
/// types.
struct PortType {
    std::string_view name;
    Shape shape;
    std::uint32_t stride;         ///< bytes an element; 0 where there are no elements
    std::string_view doc;         ///< meaning, space, order
    std::string_view format = ""; ///< an element in GLSL's words: "vec3"; "" = has no elements
    std::string_view unit = "";   ///< of its numbers: "m"; "" = none, or told in `doc`
    /// Where every number of a valid value lies, inclusive; infinite where nothing is promised.
    float min = -std::numeric_limits<float>::infinity();
    float max = std::numeric_limits<float>::infinity();

    friend bool operator==(const PortType& a, const PortType& b) { return a.name == b.name; }
};

/// "Depth (float, m, at least 0): view depth along ...": for messages and manuals.
[[nodiscard]] std::string describe(const PortType& type);

namespace types {

inline constexpr PortType kScene{"Scene", Shape::kScene, 0,
                                 "geometry, materials, lights, probes; world space, metres"};
inline constexpr PortType kCamera{"Camera", Shape::kCamera, 0, "pinhole or thin-lens camera"};
inline constexpr PortType kExtent{"Extent", Shape::kExtent, 0, "image width and height in pixels"};
inline constexpr PortType kHits{"Hits", Shape::kPlane, 8,
                                "(instance, primitive) seen through each pixel's centre", "uvec2"};
inline constexpr PortType kDepth{
    "Depth", Shape::kPlane, 4, "view depth along the camera's axis; 0 = nothing seen",
    "float", "m",           0};
inline constexpr PortType kRadiance{"Radiance", Shape::kPlane, 12, "linear scene-referred RGB",
                                    "vec3",     "W/(sr m^2)",  0};
inline constexpr PortType kDisplay{
    "Display", Shape::kPlane, 12, "display-referred sRGB-encoded RGB", "vec3", "", 0, 1};
inline constexpr PortType kError{"Error",
                                 Shape::kPlane,
                                 8,
                                 "(expect, bound), finite: best guess of |raster - traced|, and a "
                                 "number never below it",
                                 "vec2",
                                 "",
                                 0};
inline constexpr PortType kAccumulation{
    "Accumulation", Shape::kPlane, 16,
    "sum of a pixel's radiance samples in sample order (xyz) and the bits of their number (w)",
    "vec4"};
inline constexpr PortType kRound{"Round", Shape::kPlane, 4,
                                 "1 + the iteration that first traced the pixel; 0 = not traced",
                                 "uint"};
inline constexpr PortType kPixelList{"PixelList", Shape::kList, 4,
                                     "pixel indices in the order they are to be refined", "uint"};
inline constexpr PortType kRequestList{
    "RequestList", Shape::kList, 12, "(pixel, first sample, sample count), in tile order", "uvec3"};
inline constexpr PortType kSamples{
    "Samples", Shape::kList, 16,
    "radiance (xyz) and the bits of the pixel (w), by request, samples ascending", "vec4"};
inline constexpr PortType kCursor{"Cursor", Shape::kRecord, 4, "how far the order was requested",
                                  "uint"};
inline constexpr PortType kScalar{"Scalar", Shape::kRecord, 4,
                                  "one number, for a loop's stop rule \"below\"", "float"};
inline constexpr PortType kSampleCounts{"SampleCounts",
                                        Shape::kPlane,
                                        4,
                                        "samples that one visit of the pixel shall take",
                                        "uint",
                                        "",
                                        1};
inline constexpr PortType kShadowMaps{"ShadowMaps", Shape::kRecord, 4,
                                      "depth cube maps by light, point, face", "float"};
inline constexpr PortType kShadowRanges{"ShadowRanges", Shape::kRecord, 8,
                                        "bits of the least and greatest depth of squares of shadow "
                                        "maps, by light, face, level",
                                        "uvec2"};
inline constexpr PortType kEnvironmentMaps{"EnvironmentMaps", Shape::kRecord, 16,
                                           "(radiance, distance) cube maps by probe, face", "vec4"};
inline constexpr PortType kOcclusion{"Occlusion",
                                     Shape::kRecord,
                                     4,
                                     "by vertex: share of the cosine-weighted hemisphere that the "
                                     "vertex's own object covers",
                                     "float",
                                     "",
                                     0,
                                     1};
inline constexpr PortType kPixelOcclusion{
    "PixelOcclusion",
    Shape::kPlane,
    4,
    "share of the cosine-weighted hemisphere that the pixel's own object covers",
    "float",
    "",
    0,
    1};
inline constexpr PortType kTolerance{
    "Tolerance",
    Shape::kPlane,
    4,
    "> 0: difference of luminance that is just not seen, as a share of display white",
    "float",
    "",
    0};
inline constexpr PortType kCurve{"Curve", Shape::kCurve, 0, "what a loop did, by iteration"};

/// Every type that hone knows by itself; plug-ins' types are those of their passes' ports
/// (graphTypes in pass_type.h finds all).
inline constexpr PortType kAll[] = {
    kScene,           kCamera,    kExtent,         kHits,         kDepth,      kRadiance,
    kDisplay,         kError,     kAccumulation,   kRound,        kPixelList,  kRequestList,
    kSamples,         kCursor,    kScalar,         kSampleCounts, kShadowMaps, kShadowRanges,
    kEnvironmentMaps, kOcclusion, kPixelOcclusion, kTolerance,    kCurve};

} // namespace types
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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
    std::uint32_t stride; ///< bytes an element; 0 where there are no elements
    std::string_view doc; ///< meaning, unit, range, space

    friend bool operator==(const PortType& a, const PortType& b) { return a.name == b.name; }
};

namespace types {

inline constexpr PortType kScene{"Scene", Shape::kScene, 0,
                                 "geometry, materials, lights, probes; world space, metres"};
inline constexpr PortType kCamera{"Camera", Shape::kCamera, 0, "pinhole or thin-lens camera"};
inline constexpr PortType kExtent{"Extent", Shape::kExtent, 0, "image width and height in pixels"};
inline constexpr PortType kHits{"Hits", Shape::kPlane, 8,
                                "uvec2 (instance, primitive) seen through each pixel's centre"};
inline constexpr PortType kDepth{
    "Depth", Shape::kPlane, 4,
    "float, view depth along the camera's axis in metres; 0 = nothing seen"};
inline constexpr PortType kRadiance{"Radiance", Shape::kPlane, 12,
                                    "vec3, linear scene-referred RGB, W / (sr m^2)"};
inline constexpr PortType kDisplay{"Display", Shape::kPlane, 12,
                                   "vec3, display-referred sRGB-encoded RGB in [0,1]"};
inline constexpr PortType kError{"Error", Shape::kPlane, 8,
                                 "vec2 (expect, bound), >= 0 and finite: best guess of |raster - "
                                 "traced|, and a number never below it"};
inline constexpr PortType kAccumulation{
    "Accumulation", Shape::kPlane, 16,
    "sum of a pixel's radiance samples in sample order (vec3) and their number (uint)"};
inline constexpr PortType kRound{
    "Round", Shape::kPlane, 4,
    "uint, 1 + the iteration that first traced the pixel; 0 = not traced"};
inline constexpr PortType kPixelList{"PixelList", Shape::kList, 4,
                                     "uint pixel indices in the order they are to be refined"};
inline constexpr PortType kRequestList{"RequestList", Shape::kList, 12,
                                       "uvec3 (pixel, first sample, sample count), in tile order"};
inline constexpr PortType kSamples{"Samples", Shape::kList, 16,
                                   "vec3 radiance and uint pixel, by request, samples ascending"};
inline constexpr PortType kCursor{"Cursor", Shape::kRecord, 4,
                                  "uint, how far the order was requested"};
inline constexpr PortType kSampleCounts{
    "SampleCounts", Shape::kPlane, 4, "uint, >= 1: samples that one visit of the pixel shall take"};
inline constexpr PortType kShadowMaps{"ShadowMaps", Shape::kRecord, 4,
                                      "float depth cube maps by light, point, face"};
inline constexpr PortType kShadowRanges{"ShadowRanges", Shape::kRecord, 8,
                                        "bits of the least and greatest depth of squares of shadow "
                                        "maps, by light, face, level"};
inline constexpr PortType kEnvironmentMaps{"EnvironmentMaps", Shape::kRecord, 16,
                                           "vec4 (radiance, distance) cube maps by probe, face"};
inline constexpr PortType kOcclusion{"Occlusion", Shape::kRecord, 4,
                                     "float in [0,1] by vertex: share of the cosine-weighted "
                                     "hemisphere that the vertex's own object covers"};
inline constexpr PortType kPixelOcclusion{
    "PixelOcclusion", Shape::kPlane, 4,
    "float in [0,1]: share of the cosine-weighted hemisphere that the pixel's own object covers"};
inline constexpr PortType kTolerance{
    "Tolerance", Shape::kPlane, 4,
    "float, > 0: difference of luminance that is just not seen, as a share of display white"};
inline constexpr PortType kCurve{"Curve", Shape::kCurve, 0, "what a loop did, by iteration"};

/// Every type that hone knows by itself; plug-ins' types are those of their passes' ports
/// (graphTypes in pass_type.h finds all).
inline constexpr PortType kAll[] = {
    kScene,     kCamera,         kExtent,       kHits,       kDepth,        kRadiance,
    kDisplay,   kError,          kAccumulation, kRound,      kPixelList,    kRequestList,
    kSamples,   kCursor,         kSampleCounts, kShadowMaps, kShadowRanges, kEnvironmentMaps,
    kOcclusion, kPixelOcclusion, kTolerance,    kCurve};

} // namespace types
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"
#include "hone/core/trace/ray.glsl.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// How the rays of a list relate to each other: a hint about speed, never about the answer.
enum class Coherence : std::uint8_t {
    kIncoherent, ///< neighbours in the list go anywhere
    kCoherent,   ///< neighbours start or end together and point alike (primary rays in tile order,
                 ///< shadow rays to a light)
};

struct TraceOptions {
    /// Every ray is answered as if it were alone, at the price of speed: the answer never depends
    /// on what else is in the list. (A backend whose caps say always_exact ignores it.)
    bool exact = false;
};

/// What a backend can do, readable before build().
struct TraceCaps {
    std::string name;          ///< "embree", "brute"
    std::string version;       ///< "3.13.5"
    bool masked = true;        ///< honours alpha-masked surfaces
    bool always_exact = false; ///< TraceOptions::exact changes nothing
};

struct BuildStats {
    double ms = 0;
    std::size_t triangles = 0; ///< in the structure, after instancing
    std::size_t bytes = 0;     ///< 0 = not known
};

/// Answers geometry questions for lists of rays: what is seen first, what is occluded. Knows
/// nothing of light.
///
/// What every backend answers, bit for bit where arithmetic allows (tests/conformance):
/// - A *closest* hit is the one with the least t in [tmin, tmax]. Back faces of materials without
/// kMaterialTwoSided are
///   not seen, as the rasteriser culls them; a front face turns counter-clockwise seen from the
///   ray's origin (clockwise where Instance::flipped). Equal t: either may be answered.
/// - *Occluded* asks whether anything is in [tmin, tmax]; both faces block.
/// - Masked materials: a point whose alpha (base level, bilinear, times Material::alpha) is below
/// alpha_cutoff is a hole.
/// - Degenerate triangles are never hit. Rays with NaN, zero direction or tmin > tmax hit nothing.
///
/// build() may be called again. Queries are const and use all cores themselves; one query at a
/// time.
class TraceBackend {
public:
    virtual ~TraceBackend() = default;
    [[nodiscard]] virtual TraceCaps caps() const = 0;
    /// Builds for `scene`, which must outlive the queries and not change (else build again).
    virtual BuildStats build(const Scene& scene) = 0;
    /// hits[i] answers rays[i]; sizes are equal. May be called with no rays.
    virtual void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                         const TraceOptions& options) const = 0;
    /// occluded[i] = 1 or 0 for rays[i]; sizes are equal.
    virtual void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                          const TraceOptions& options) const = 0;
};

/// The backends that this program offers, by name; filled by the application (backends never
/// register themselves).
class TraceBackendRegistry {
public:
    using Factory = std::function<std::unique_ptr<TraceBackend>()>;
    void add(std::string name, std::string doc, Factory factory);
    /// In order of preference: "auto" is the first.
    [[nodiscard]] std::vector<std::string> names() const;
    /// What "auto" stands for. Throws std::logic_error if there is none.
    [[nodiscard]] const std::string& preferred() const;
    [[nodiscard]] bool contains(std::string_view name) const;
    /// Throws std::logic_error for a name that is not there ("auto" is resolved by the caller to
    /// preferred()).
    [[nodiscard]] std::unique_ptr<TraceBackend> create(std::string_view name) const;

private:
    struct Entry {
        std::string name, doc;
        Factory factory;
    };
    std::vector<Entry> entries_;
};

} // namespace hone

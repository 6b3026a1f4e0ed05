// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/devices.h"
#include "hone/core/scene/scene.h"
#include "hone/core/trace/ray.glsl.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

class SceneBuffers;
struct CheckReport;

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

/// Where a backend reads rays and writes answers.
enum class TraceMemory : std::uint8_t {
    kHost,   ///< any bytes of the host
    kDevice, ///< the buffers of Devices::memory(); lists that lie elsewhere are copied
};

/// What a backend can do, readable before build().
struct TraceCaps {
    std::string name;    ///< "embree", "vulkan.ray_query"
    std::string version; ///< "3.13.5"; of a device its driver's
    std::string runs_on; ///< "host", or the device's name
    TraceMemory memory = TraceMemory::kHost;
    bool masked = true;        ///< honours alpha-masked surfaces
    bool always_exact = false; ///< TraceOptions::exact changes nothing
    bool settles_ties = false; ///< of closest hits of equal t the least (instance, primitive) wins
    bool updates = false;      ///< update() is less work than build()
    bool is_reference = false; ///< linear in the scene's triangles: for tiny scenes, never "auto"
};

/// What a build or an update made.
struct BuildStats {
    double ms = 0;
    std::size_t triangles = 0;    ///< in the structure, after instancing
    std::size_t bytes = 0;        ///< of the structure; 0 = not known
    std::size_t copied_bytes = 0; ///< of the scene's arrays that exist once more because of it
};

/// Answers geometry questions for lists of rays: what is seen first, what is occluded. Knows
/// nothing of light.
///
/// What every backend answers, bit for bit where arithmetic allows (tests/conformance):
/// - A *closest* hit is the one with the least t in [tmin, tmax]. Back faces of materials without
/// kMaterialTwoSided are not seen, as the rasteriser culls them; a front face turns
/// counter-clockwise seen from the ray's origin (clockwise where Instance::flipped). Equal t:
/// either may be answered, unless caps say settles_ties.
/// - *Occluded* asks whether anything is in [tmin, tmax]; both faces block.
/// - Masked materials: a point whose alpha (base level, bilinear, times Material::alpha) is below
/// alpha_cutoff is a hole.
/// - Degenerate triangles are never hit. Rays with NaN, zero direction or tmin > tmax hit nothing.
///
/// build() may be called again. Queries are const and use all cores or the device themselves; one
/// query at a time, and none beside other work on the devices that the backend was made for.
/// Throws DeviceError, OutOfMemory.
class TraceBackend {
public:
    virtual ~TraceBackend() = default;
    [[nodiscard]] virtual TraceCaps caps() const = 0;
    /// Builds for `scene`, which must outlive the queries and not change (else build again).
    /// `shared`: its arrays in the memory of the backend's devices, if the caller has them there;
    /// they must outlive the queries, too. Null: the backend brings over what it needs.
    virtual BuildStats build(const Scene& scene, const SceneBuffers* shared) = 0;
    BuildStats build(const Scene& scene) { return build(scene, nullptr); }
    /// Follows instances that moved in the scene that was built (moveInstance): answers are as if
    /// it were built anew. `moved` ascends. Where caps do not say updates, it is built anew.
    virtual BuildStats update(std::span<const uint> moved) = 0;
    /// hits[i] answers rays[i]; sizes are equal. May be called with no rays.
    virtual void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                         const TraceOptions& options) const = 0;
    /// occluded[i] = 1 or 0 for rays[i]; sizes are equal.
    virtual void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                          const TraceOptions& options) const = 0;
    /// Bytes of rays and answers that were copied since this was made, for they lay where it cannot
    /// use them (QueryMemory); 0 where all memory will do.
    [[nodiscard]] virtual std::size_t copiedBytes() const { return 0; }
};

/// The backends that this program offers, by name; filled by the application (backends never
/// register themselves). Wherever a name is taken, "check(X)" and "check(X,Y)" are, too
/// (check_backend.h), X and Y being "auto" or names of those.
class TraceBackendRegistry {
public:
    /// Makes a backend that may use these devices. Throws DeviceError that says what is missing.
    using Factory = std::function<std::unique_ptr<TraceBackend>(const Devices&)>;
    void add(std::string name, std::string doc, Factory factory);
    /// As they were added: in order of preference among equally fast ones.
    [[nodiscard]] std::vector<std::string> names() const;
    /// The first. Throws std::logic_error if there is none.
    [[nodiscard]] const std::string& preferred() const;
    [[nodiscard]] bool contains(std::string_view name) const;
    /// Throws std::logic_error for a name that is not there ("auto" is none: see
    /// chooseTracer()).
    [[nodiscard]] std::unique_ptr<TraceBackend> create(std::string_view name,
                                                       const Devices& devices) const {
        return wrap(createBare(name, devices));
    }
    /// create() without what wrapEach() puts around: for trying backends out, of which wrap()
    /// then makes the chosen one what create() had given.
    [[nodiscard]] std::unique_ptr<TraceBackend> createBare(std::string_view name,
                                                           const Devices& devices) const;
    [[nodiscard]] std::unique_ptr<TraceBackend> wrap(std::unique_ptr<TraceBackend> backend) const;

    /// Where checks that are created from now on add what they find; it must outlive them.
    void reportChecksTo(CheckReport& report) { check_report_ = &report; }
    /// Puts something around every backend that is created from now on.
    using Wrapper = std::function<std::unique_ptr<TraceBackend>(std::unique_ptr<TraceBackend>)>;
    void wrapEach(Wrapper wrapper) { wrapper_ = std::move(wrapper); }

private:
    struct Entry {
        std::string name, doc;
        Factory factory;
    };
    std::vector<Entry> entries_;
    CheckReport* check_report_ = nullptr;
    Wrapper wrapper_;
};

} // namespace hone

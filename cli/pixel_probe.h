// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/session.h"

#include "hone/core/trace/check/explain_difference.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hone::cli {

/// What two trace backends answered differently for one pixel.
struct PixelReason {
    const char* kind = ""; ///< of the ray: "primary", "shadow", "mirror", "mirror_shadow"
    Ray ray{};
    Difference difference;
    std::string answers[2]; ///< in words
};

/// Traces single pixels of an image again, asking two backends the same rays, to say why their
/// images differ there.
class PixelProbe {
public:
    struct Setup {
        std::string graph; ///< whose trace pass made the images
        Overrides overrides;
        std::string scene;
        std::string camera;
        std::string path; ///< "" = the camera, else where it is on the path:
        float time = 0;   ///< seconds
        uvec2 extent{0, 0};
        std::uint64_t seed = 0;
        std::vector<std::string> plugins; ///< files that offer backends
        std::string backends[2];          ///< the first one's answers make the following rays
    };
    /// Throws GraphError, SceneError, DeviceError; InputError if the graph traces nothing or a
    /// backend is unknown.
    explicit PixelProbe(const Setup& setup);
    ~PixelProbe();

    /// The first ray of the pixel (y * width + x) that the two answer differently; nothing if they
    /// agree on all.
    [[nodiscard]] std::optional<PixelReason> ask(uint pixel);

private:
    class BothTracers;
    Session session_; // owns the devices: before what lives on them
    PassRegistry passes_;
    TraceBackendRegistry tracers_;
    Scene scene_;
    std::optional<PixelReason> reason_; ///< of the pixel that is being asked about
    BothTracers* tracer_ = nullptr;     ///< the executor's, once it traces
    std::unique_ptr<Executor> executor_;
};

} // namespace hone::cli

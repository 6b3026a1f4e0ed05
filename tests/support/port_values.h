// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/scene.h"
#include "hone/tests/support/run_pass.h"

#include <string>

namespace hone::test {

/// What numbers generated inputs hold. All but the last are valid values of their type.
enum class Content : std::uint8_t {
    kZeros,    ///< 0, or the least that the type allows
    kRandom,   ///< of everyday size
    kExtremes, ///< the least and greatest, denormals, -0
    kHostile,  ///< also NaN, infinities and what is out of range; what is no number stays valid
};
/// How many elements lists have, and ports that take several edges edges.
enum class Fill : std::uint8_t { kEmpty, kSome, kFull };

/// What the inputs of one execution agree on.
struct Frame {
    const Scene* scene = nullptr; ///< finished
    Camera camera{};
    uvec2 extent{7, 5};
    Content content = Content::kRandom;
    Fill fill = Fill::kSome;
    uint seed = 1;
    bool has_tiny = true;            ///< whether extremes reach down to denormals
    bool has_greater_errors = false; ///< some numbers of errors are greater than without
    bool is_reversed = false;        ///< planes' last pixels come first

    [[nodiscard]] uint pixels() const { return extent.x * extent.y; }
};

/// Faces of generated shadow maps have so many texels along an edge; passes that must agree with
/// them (parameter "size") are told so by their tests.
inline constexpr uint kMapSize = 16;

/// Feeds a port with a value of its type that agrees with the frame. The same frame, port name and
/// `turn` (which edge of several) give the same bytes; records are the same at every port. Scenes
/// and cameras are PassRun's business. Throws std::logic_error for a type that has no numbers and
/// that nothing is known about.
void feedPort(PassRun& run, const InPort& port, const Frame& frame, uint turn = 0);

/// The elements, the last first.
[[nodiscard]] std::vector<std::byte> reversed(std::span<const std::byte> elements,
                                              std::size_t stride);

/// What makes the value invalid as one of its type, for a frame; "" if nothing does.
///
/// Types whose range has an end, errors and tolerances hold finite numbers in their range whatever
/// the inputs were. Other numbers may overflow where inputs are extreme, and be anything where they
/// are hostile.
[[nodiscard]] std::string problemOf(const Value& value, const Frame& frame);

} // namespace hone::test

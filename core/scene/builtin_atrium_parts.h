// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/scene/builtin_shape.h"

namespace hone {

// What the atrium is built of. Metres; each part stands on y = 0 or says where it hangs.

/// A round column with entasis on a square plinth under a square abacus.
[[nodiscard]] Shape columnPart(float radius, float height, uint sides);

/// A wall 3 m wide, 0.64 m thick, x in [-1.5, 1.5], with a round arch of radius 1.1 that springs at
/// y = 0; moulded on both faces, open at its sides and top (y = top), where the next part begins.
[[nodiscard]] Shape archPart(float top);

/// A floor's edge or cornice: a moulded band along x, front to +z at z = 0, y in [0, height];
/// open at back and ends.
[[nodiscard]] Shape bandPart(float length, float height, float depth);

/// A row of `count` small blocks under a band, `pitch` apart, centred at x = 0.
[[nodiscard]] Shape dentilPart(uint count, float pitch);

/// An iron railing along x, 1 m high: rails, turned bars and rings between them.
[[nodiscard]] Shape railingPart(float length, uint bars);

/// A pair of curtains on a rod at y = 0, tied to both sides of an opening of that width.
[[nodiscard]] Shape curtainPart(float width, float height);
[[nodiscard]] Shape curtainRodPart(float width);

/// A banner that hangs from y = 0, front to +z.
[[nodiscard]] Shape bannerPart(float width, float height);

/// A pot, the earth in it, and leaves that grow from its top.
[[nodiscard]] Shape potPart();
[[nodiscard]] Shape leavesPart(uint count, float length, float lift, uint seed);

/// A bowl on three chains; the hook is at y = 0, the bowl `drop` below it.
[[nodiscard]] Shape hangingBowlPart(float drop);
[[nodiscard]] Shape hangingChainsPart(float drop);

/// A trefoil knot of that size (from its centre to its outside) about the x axis, centre at the
/// origin, one lobe down.
[[nodiscard]] Shape knotPart(float size);

/// The wall of a round basin, and the foot in its middle.
[[nodiscard]] Shape basinPart(float radius, float height);
[[nodiscard]] Shape pedestalPart(float height);

} // namespace hone

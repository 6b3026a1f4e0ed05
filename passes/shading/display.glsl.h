// SPDX-License-Identifier: Apache-2.0
//
// What a screen shows of a channel's radiance: tonemap's whole transform, which passes that judge
// images need, too. Per channel and the same everywhere in an image, so an error bound in radiance
// stays a bound after it.
// Kernel source: included flat, once, inside a kernel.
#include "hone/passes/shading/srgb.glsl.h"

HONE_CONST uint kCurveClip = 0u;
HONE_CONST uint kCurveReinhard = 1u;

/// Reinhard's curve (2002, equation 4) with white at 4: keeps dark values, never exceeds 1 below
/// white. What is brighter is white, however bright: infinity over infinity is no number.
float reinhard(float x) {
    float cut = min(x, 4.0f);
    return min(cut * (1.0f + cut * (1.0f / 16.0f)) / (1.0f + cut), 1.0f);
}

/// Exposed, curved, cut to [0,1] (NaN to 0), sRGB-encoded.
float displayed(float radiance, float exposure, uint curve) {
    float x = radiance * exposure;
    x = x > 0.0f ? x : 0.0f;
    return encodeSrgb(min(curve == kCurveReinhard ? reinhard(x) : x, 1.0f));
}

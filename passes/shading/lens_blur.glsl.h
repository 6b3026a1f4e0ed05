// SPDX-License-Identifier: Apache-2.0
//
// Depth of field as a weighted mean of what the pixels around show, with weights that depend on
// depth only: what blurs an image blurs its error, too. Kernel source: included flat, once, inside
// a kernel (kernel.glsl.h), after its
//     vec3 blurSource(uint pixel)   what is blurred
// LensBlur (lens_blur.h) fills the buffers.

HONE_READ(float, confusion)  // signed diameter in pixels by pixel
HONE_READ(float, blur_reach) // by tile: greatest radius in pixels of what reaches into it

/// Side of the tiles of blur_reach in pixels.
HONE_CONST uint kBlurTile = 16u;

struct BlurWindow {
    uvec2 extent;
    uint taps;          ///< at most so many pixels around are looked at, evenly spread; 0: all
    float radius_limit; ///< pixels
};

#ifdef __cplusplus
using BlurReal = float;
using BlurMask = bool;
using BlurColor = vec3;
#else
#define BlurReal float
#define BlurMask bool
#define BlurColor vec3
#endif
#include "hone/passes/shading/blur_layers.glsl.h"

/// What is huge is cut where it is spread, so that sums stay finite: infinity times a layer's share
/// of 0 would be no number.
HONE_CONST float kBrightest = 1e30f;
float cutToSum(float x) {
    return x > kBrightest ? kBrightest : x;
}

/// The pixels around one that are looked at: a lattice through it, cut off at the image's border.
struct BlurTaps {
    int stride;  ///< pixels from one to the next
    ivec2 first; ///< in strides from the pixel
    ivec2 last;
};

/// The tile that a pixel is in.
uint blurTile(uint index, uvec2 extent) {
    uint tiles_x = (extent.x + kBlurTile - 1u) / kBlurTile;
    return index / extent.x / kBlurTile * tiles_x + index % extent.x / kBlurTile;
}

/// How far away, in pixels, something may be that spreads to this pixel; at most 1/2: nothing does.
float blurReach(uint index, uvec2 extent) {
    return blur_reach[blurTile(index, extent)];
}

/// Takes all pixels in reach, or as many as `taps` are, evenly spread; `taps` 0: all.
BlurTaps blurTaps(uint index, uvec2 extent, uint taps) {
    int radius = int(floor(blurReach(index, extent) + 0.5f));
    BlurTaps result;
    result.stride = 1;
    if (taps != 0u)
        while ((2 * (radius / result.stride) + 1) * (2 * (radius / result.stride) + 1) > int(taps))
            result.stride += 1;
    int steps = radius / result.stride;
    int x = int(index % extent.x);
    int y = int(index / extent.x);
    result.first = ivec2(-min(steps, x / result.stride), -min(steps, y / result.stride));
    result.last = ivec2(min(steps, (int(extent.x) - 1 - x) / result.stride),
                        min(steps, (int(extent.y) - 1 - y) / result.stride));
    return result;
}

/// How much the blur of the surface that a pixel shows grows per pixel to the right and down.
vec2 blurSlope(uint index, uvec2 extent) {
    uint left = index % extent.x > 0u ? 1u : 0u;
    uint right = index % extent.x + 1u < extent.x ? 1u : 0u;
    uint above = index / extent.x > 0u ? extent.x : 0u;
    uint below = index / extent.x + 1u < extent.y ? extent.x : 0u;
    float here = confusion[index];
    vec2 before = vec2(here - confusion[index - left], here - confusion[index - above]);
    vec2 after = vec2(confusion[index + right] - here, confusion[index + below] - here);
    vec2 slope;
    slope.x = right == 0u || (left != 0u && abs(before.x) < abs(after.x)) ? before.x : after.x;
    slope.y = below == 0u || (above != 0u && abs(before.y) < abs(after.y)) ? before.y : after.y;
    return slope;
}

BlurSurface blurSurface(uint index, BlurWindow window) {
    BlurSurface surface;
    surface.disc = blurDisc(confusion[index], window.radius_limit);
    vec2 slope = blurSlope(index, window.extent);
    surface.slope_x = slope.x;
    surface.slope_y = slope.y;
    surface.inverse_tolerance = inverseTolerance(surface.disc.diameter);
    return surface;
}

/// The pixel that a step in strides leads to.
uint blurPixel(uint index, BlurWindow window, BlurTaps taps, int step_x, int step_y) {
    return uint(int(index) + taps.stride * (step_y * int(window.extent.x) + step_x));
}

/// The image of a lens from that of a pinhole. Each pixel spreads evenly over its disc of
/// confusion; what arrives at a pixel p is kept in three layers: what lies in front of the surface
/// that p shows, that surface, and what lies behind it, each a mean of its pixels' colours. The
/// front covers the sum of what its discs show at p, and the surface the share of p's disc in which
/// nothing behind it is seen. So a sharp object keeps its edge against a blurred background, and a
/// blurred one spreads over it; what a blurred edge lays open is made up from the background
/// around. A pixel that nothing spreads to keeps its bits. Sources: Potmesil and Chakravarty 1981
/// (the disc); Kraus and Strengert, Depth-of-Field Rendering by Pyramidal Image Processing, 2007
/// (layers); Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, 2014
/// (scatter as gather). The layers' shares and the plane are hone's own.
vec3 lensBlurred(uint index, BlurWindow window) {
    vec3 here = blurSource(index);
    if (blurReach(index, window.extent) <= 0.5f)
        return here;
    BlurSurface surface = blurSurface(index, window);

    // Sum the layers.
    BlurLayers layers;
    layers.front = vec3(0.0f);
    layers.own = vec3(0.0f);
    layers.behind = vec3(0.0f);
    layers.front_weight = 0.0f;
    layers.own_weight = 0.0f;
    layers.behind_weight = 0.0f;
    layers.open_weight = 0.0f;
    layers.arrivals = 0.0f;
    BlurTaps taps = blurTaps(index, window.extent, window.taps);
    for (int step_y = taps.first.y; step_y <= taps.last.y; ++step_y) {
        for (int step_x = taps.first.x; step_x <= taps.last.x; ++step_x) {
            uint pixel = blurPixel(index, window, taps, step_x, step_y);
            BlurStep off = blurStep(step_x * taps.stride, step_y * taps.stride);
            BlurDisc disc = blurDisc(confusion[pixel], window.radius_limit);
            if (isOutOfReach(surface, disc, off))
                continue;
            vec3 color = blurSource(pixel);
            color = vec3(cutToSum(color.x), cutToSum(color.y), cutToSum(color.z));
            addToLayers(layers, blurShare(surface, disc, off), off, color);
        }
    }
    if (layers.arrivals <= 1.0f)
        return here;

    // Lay them over each other.
    float tap_area = float(taps.stride * taps.stride);
    vec3 result;
    result.x = laidOver(layers, layers.front.x, layers.own.x, layers.behind.x, tap_area);
    result.y = laidOver(layers, layers.front.y, layers.own.y, layers.behind.y, tap_area);
    result.z = laidOver(layers, layers.front.z, layers.own.z, layers.behind.z, tap_area);
    return result;
}

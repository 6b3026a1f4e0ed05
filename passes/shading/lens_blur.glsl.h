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

float blurRadius(float diameter, float radius_limit) {
    return clamp(0.5f * abs(diameter), 0.5f, radius_limit);
}

/// One by how many pixels a disc covers.
float inverseArea(float radius) {
    return 1.0f / (3.14159265f * (radius * radius + 0.0833333f));
}

/// How far a disc covers a pixel `away` from its middle: its rim is a pixel wide, so that the sum
/// over all pixels is the area. A radius of 1/2 is a pixel that keeps all to itself.
float discCover(float radius, float away) {
    return clamp(radius - away + 0.5f, 0.0f, 1.0f);
}

/// How much farther than p's surface a pixel lies, in pixels of blur: measured from its plane and
/// from its depth, whichever is nearer, for both are the same surface.
float blurBehind(float difference, float slope) {
    float from_plane = difference - slope;
    if (difference * from_plane <= 0.0f)
        return 0.0f;
    return abs(difference) < abs(from_plane) ? difference : from_plane;
}

/// The pixels around one that are looked at: a lattice through it, cut off at the image's border.
struct BlurTaps {
    int stride;  ///< pixels from one to the next
    ivec2 first; ///< in strides from the pixel
    ivec2 last;
};

struct BlurTap {
    uint pixel;
    float dx; ///< pixels from the middle one
    float dy;
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

BlurTap blurTap(BlurTaps taps, uint index, uvec2 extent, int step_x, int step_y) {
    BlurTap tap;
    int dx = step_x * taps.stride;
    int dy = step_y * taps.stride;
    tap.pixel = uint(int(index) + dy * int(extent.x) + dx);
    tap.dx = float(dx);
    tap.dy = float(dy);
    return tap;
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

/// The surface that a pixel shows.
struct BlurSurface {
    float diameter;
    float radius;
    vec2 slope;
    float inverse_area;      ///< of its disc
    float inverse_tolerance; ///< surfaces whose blur differs by more than one over this are two
};

BlurSurface blurSurface(uint index, BlurWindow window) {
    BlurSurface surface;
    surface.diameter = confusion[index];
    surface.radius = blurRadius(surface.diameter, window.radius_limit);
    surface.inverse_area = inverseArea(surface.radius);
    surface.slope = blurSlope(index, window.extent);
    // Less than a pixel, or an eighth, is the same blur anyway.
    surface.inverse_tolerance = 1.0f / max(1.0f, 0.125f * abs(surface.diameter));
    return surface;
}

/// Whether the discs of a tap and of p are too small for the two to touch, without a root.
bool isOutOfReach(BlurSurface surface, BlurTap tap, float radius_limit) {
    float reach = max(surface.radius, blurRadius(confusion[tap.pixel], radius_limit)) + 0.5f;
    return tap.dx * tap.dx + tap.dy * tap.dy >= reach * reach;
}

/// How a tap counts for a pixel p. It is in one of three layers, or between two of them.
struct BlurShare {
    float away;     ///< pixels from p
    float spread;   ///< what it spreads to p
    float open;     ///< its part of p's own disc
    float is_front; ///< in front of p's surface, as a part of 1
    float is_own;
    float is_behind;
};

BlurShare blurShare(BlurSurface surface, BlurTap tap, float radius_limit) {
    BlurShare share;
    float diameter = confusion[tap.pixel];
    share.away = sqrt(tap.dx * tap.dx + tap.dy * tap.dy);
    float radius = blurRadius(diameter, radius_limit);
    share.spread = discCover(radius, share.away) * inverseArea(radius);
    share.open = discCover(surface.radius, share.away) * surface.inverse_area;
    float farther = blurBehind(diameter - surface.diameter,
                               surface.slope.x * tap.dx + surface.slope.y * tap.dy) *
                    surface.inverse_tolerance;
    share.is_front = clamp(-farther - 1.0f, 0.0f, 1.0f);
    share.is_behind = clamp(farther - 1.0f, 0.0f, 1.0f);
    share.is_own = 1.0f - share.is_front - share.is_behind;
    return share;
}

/// Where nothing behind spreads to p, the nearest of it that p's disc lays open will do.
float fillWeight(BlurShare share) {
    if (share.is_behind == 0.0f)
        return 0.0f;
    float nearness = 1e-4f / (1.0f + share.away * share.away);
    return share.is_behind * (share.spread + nearness * share.open);
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
    vec3 front = vec3(0.0f);
    vec3 own = vec3(0.0f);
    vec3 behind = vec3(0.0f);
    float front_weight = 0.0f;
    float own_weight = 0.0f;
    float behind_weight = 0.0f;
    float open_weight = 0.0f;
    uint arrivals = 0u;
    BlurTaps taps = blurTaps(index, window.extent, window.taps);
    for (int step_y = taps.first.y; step_y <= taps.last.y; ++step_y) {
        for (int step_x = taps.first.x; step_x <= taps.last.x; ++step_x) {
            BlurTap tap = blurTap(taps, index, window.extent, step_x, step_y);
            if (isOutOfReach(surface, tap, window.radius_limit))
                continue;
            BlurShare share = blurShare(surface, tap, window.radius_limit);
            float fills = fillWeight(share);
            vec3 color = blurSource(tap.pixel);
            front += share.is_front * share.spread * color;
            own += share.is_own * share.spread * color;
            behind += fills * color;
            front_weight += share.is_front * share.spread;
            own_weight += share.is_own * share.spread;
            behind_weight += fills;
            open_weight += share.is_behind * share.open;
            if ((1.0f - share.is_behind) * share.spread + share.is_behind * share.open > 0.0f)
                arrivals += 1u;
        }
    }
    if (arrivals <= 1u)
        return here;

    // Lay them over each other. The surface's weight is never 0, for p is of it.
    vec3 result = own / own_weight;
    if (open_weight > 0.0f) {
        float covers = own_weight / (own_weight + open_weight);
        result = covers * result + (1.0f - covers) * (behind / behind_weight);
    }
    if (front_weight > 0.0f) {
        float covers = min(front_weight * float(taps.stride * taps.stride), 1.0f);
        result = covers * (front / front_weight) + (1.0f - covers) * result;
    }
    return result;
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/sanitised.glsl.h"

#include "hone/passes/shading/srgb.glsl.h"

struct Params {
    uvec2 extent;
    uint taps; ///< of depth_of_field
    uint estimate_taps;
    float radius_limit;
    uint space;
    float least;
};
HONE_PARAMS(Params)
HONE_READ(vec3, image)
HONE_READ(uint, flagged)
HONE_WRITE(vec2, error)

HONE_CONST uint kDisplay = 0u;

vec3 blurSource(uint pixel) {
    return image[pixel];
}

#include "hone/passes/shading/lens_blur.glsl.h"

/// A layer's colours.
struct Layer {
    float weight;
    vec3 sum;
    vec3 squares;
};

Layer noLayer() {
    Layer layer;
    layer.weight = 0.0f;
    layer.sum = vec3(0.0f);
    layer.squares = vec3(0.0f);
    return layer;
}

void addTo(HONE_INOUT(Layer) layer, float weight, vec3 color) {
    if (weight == 0.0f)
        return;
    layer.weight += weight;
    layer.sum += weight * color;
    layer.squares += weight * color * color;
}

vec3 meanOf(Layer layer) {
    return layer.weight > 0.0f ? layer.sum / layer.weight : vec3(0.0f);
}

vec3 deviationOf(Layer layer) {
    if (layer.weight <= 0.0f)
        return vec3(0.0f);
    vec3 mean = layer.sum / layer.weight;
    return sqrt(max(layer.squares / layer.weight - mean * mean, vec3(0.0f)));
}

/// What part of a step is lost because pixels' centres stand for areas, where its edge is blurred
/// to discs of `radius` and the filter looks at every `stride`th pixel: each of those that the edge
/// crosses in the disc is wrong by about 0.3 of its area, independently.
float edgeLoss(float radius, float stride) {
    float area = max(3.14159265f * radius * radius, 1.0f);
    return min(0.3f * stride * sqrt(2.0f * radius * stride) / area, 1.0f);
}

float shown(float radiance) {
    return params.space == kDisplay ? encodeSrgb(clamp(radiance, 0.0f, 1.0f)) : radiance;
}

/// How far a channel may be from where it is, in the chosen space. That is concave: less light
/// makes more of a difference, where there is so much to lose.
float shownError(float value, float off) {
    if (off <= 0.0f)
        return 0.0f;
    float here = shown(value);
    float less = here - shown(max(value - off, 0.0f));
    return value >= off ? less : max(less, shown(value + off) - here);
}

/// What is blurred with something that is no number is none itself.
float expected(float value, float off) {
    return isFinite(value) ? sanitised(shownError(value, off)) : 1.0f;
}

/// The steps to the pixel's neighbours. Where they are blurred to more than a pixel or two, this is
/// nothing.
vec3 lossAtNeighbours(uint index) {
    int x = int(index % params.extent.x);
    int y = int(index / params.extent.x);
    vec3 loss = vec3(0.0f);
    for (int i = 0; i < 9; ++i) {
        int other_x = clamp(x + i % 3 - 1, 0, int(params.extent.x) - 1);
        int other_y = clamp(y + i / 3 - 1, 0, int(params.extent.y) - 1);
        uint other = uint(other_y) * params.extent.x + uint(other_x);
        // It is the nearer surface that ends at the edge.
        float diameter = min(confusion[index], confusion[other]);
        loss = max(loss, edgeLoss(0.5f * abs(diameter), 1.0f) * abs(image[other] - image[index]));
    }
    return loss;
}

/// The same layers as in lensBlurred(), with the spread of their colours, and what each may be
/// wrong by.
void kernel(uint index) {
    BlurWindow window;
    window.extent = params.extent;
    window.taps = params.taps;
    window.radius_limit = params.radius_limit;
    float stride = float(blurTaps(index, params.extent, params.taps).stride);
    BlurTaps taps = blurTaps(index, params.extent, params.estimate_taps);
    float tap_area = float(taps.stride * taps.stride);
    BlurSurface surface = blurSurface(index, window);

    Layer front = noLayer();
    Layer own = noLayer();
    Layer behind = noLayer();
    float hidden_weight = 0.0f; // of p's disc: what lies in front of its surface,
    float open_weight = 0.0f;   // behind it,
    float inside_weight = 0.0f; // and in the image at all
    float front_radius = 0.0f;
    for (int step_y = taps.first.y; step_y <= taps.last.y; ++step_y) {
        for (int step_x = taps.first.x; step_x <= taps.last.x; ++step_x) {
            uint pixel = blurPixel(index, window, taps, step_x, step_y);
            BlurStep off = blurStep(step_x * taps.stride, step_y * taps.stride);
            BlurDisc disc = blurDisc(confusion[pixel], params.radius_limit);
            if (isOutOfReach(surface, disc, off))
                continue;
            BlurShare share = blurShare(surface, disc, off);
            vec3 color = image[pixel];
            addTo(front, share.is_front * share.spread, color);
            addTo(own, share.is_own * share.spread, color);
            addTo(behind, fillWeight(share, off), color);
            front_radius += share.is_front * share.spread * 0.5f * abs(disc.diameter);
            hidden_weight += share.is_front * share.open;
            open_weight += share.is_behind * share.open;
            inside_weight += share.open;
        }
    }
    float own_cover = own.weight / (own.weight + open_weight);
    float front_cover = min(front.weight * tap_area, 1.0f);
    vec3 under = own_cover * meanOf(own) + (1.0f - own_cover) * meanOf(behind);
    vec3 blurred = front_cover * meanOf(front) + (1.0f - front_cover) * under;

    // What the pixels' centres miss of the surface, wherever it is blurred.
    float own_loss = edgeLoss(0.5f * abs(surface.disc.diameter), stride);
    vec3 off = max(lossAtNeighbours(index), 2.0f * own_loss * deviationOf(own));

    if (flagged[index] != 0u) {
        // What the pinhole did not see: behind the surface, behind what is in front of it, and
        // beyond the border; it may be as far off as what it saw there varies.
        float hidden = hidden_weight / (hidden_weight + own.weight + open_weight);
        float outside = clamp(1.0f - inside_weight * tap_area, 0.0f, 1.0f);
        vec3 unseen = (1.0f - own_cover) * deviationOf(behind) +
                      min(hidden + outside, 1.0f) * deviationOf(own);
        // What the pixels' centres miss where one layer ends before another, and of the front.
        vec3 step = 4.0f * own_cover * (1.0f - own_cover) * abs(meanOf(own) - meanOf(behind));
        off += (1.0f - front_cover) * (unseen + own_loss * step);
        if (front.weight > 0.0f) {
            vec3 front_step = 4.0f * (1.0f - front_cover) * abs(meanOf(front) - under);
            off += edgeLoss(front_radius / front.weight, stride) * front_cover *
                   (front_step + 2.0f * deviationOf(front));
        }
    }
    float expect = max(max(expected(blurred.x, off.x), expected(blurred.y, off.y)),
                       expected(blurred.z, off.z));
    bool may_be_wrong = flagged[index] != 0u || expect > params.least;
    error[index] = may_be_wrong ? vec2(expect, max(1.0f, expect)) : vec2(0.0f);
}

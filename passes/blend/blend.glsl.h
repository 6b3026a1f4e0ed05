// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint samples;
    uint mode;
    uint has_base;
    uint has_error;
    float credit;
    float sigma;
    uint round_number; ///< of this iteration, from 1
};
HONE_PARAMS(Params)
HONE_READ(uvec3, requests)
HONE_READ(Accumulated, accumulation)
HONE_READ(vec3, base)
HONE_READ(vec2, error)
HONE_WRITE(vec3, image)
HONE_WRITE(uint, round_of)

HONE_CONST uint kReplace = 0u;
HONE_CONST uint kRamp = 1u;

/// How many samples the base is worth: sigma^2 / e^2, but not more than all. An exact base is worth
/// them all; of an error that is no number nothing is known, so the base is worth nothing.
float creditOf(uint pixel) {
    float most = float(params.samples);
    if (params.has_error == 0u)
        return min(params.credit, most);
    float e = error[pixel].x;
    if (!(e >= 0.0f))
        return 0.0f;
    if (e * e * most <= params.sigma * params.sigma)
        return most;
    float deviations = params.sigma / e;
    return deviations * deviations;
}

/// How much the mean of n samples counts against the base.
float shareOfMean(float n, uint pixel) {
    float part = n / float(params.samples);
    return params.mode == kRamp ? part : n / (n + creditOf(pixel) * (1.0f - part));
}

void kernel(uint index) {
    uint pixel = requests[index].x;
    Accumulated traced = accumulation[pixel];
    if (traced.count == 0u)
        return;
    if (round_of[pixel] == 0u)
        round_of[pixel] = params.round_number;
    vec3 mean = traced.sum / float(traced.count);
    // Finished pixels are copied: base + 1 * (mean - base) is not mean in floating point.
    if (params.mode == kReplace || params.has_base == 0u || traced.count >= params.samples) {
        image[pixel] = mean;
        return;
    }
    float alpha = shareOfMean(float(traced.count), pixel);
    image[pixel] = base[pixel] + alpha * (mean - base[pixel]);
}

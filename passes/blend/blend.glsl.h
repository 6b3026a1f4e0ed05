// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint samples;
    uint mode;
    uint has_base;
    uint round_number; ///< of this iteration, from 1
};
HONE_PARAMS(Params)
HONE_READ(uvec3, requests)
HONE_READ(Accumulated, accumulation)
HONE_READ(vec3, base)
HONE_WRITE(vec3, image)
HONE_WRITE(uint, round_of)

HONE_CONST uint kReplace = 0u;

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
    float alpha = float(traced.count) / float(params.samples);
    image[pixel] = base[pixel] + alpha * (mean - base[pixel]);
}

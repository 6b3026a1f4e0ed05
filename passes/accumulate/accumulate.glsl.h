// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint sample_count; ///< in the list, which has room for more
};
HONE_PARAMS(Params)
HONE_READ(Sample, samples)
HONE_WRITE(Accumulated, accumulation)

/// The first of a pixel's samples adds them all, in their order.
void kernel(uint index) {
    uint pixel = samples[index].pixel;
    if (index > 0u && samples[index - 1u].pixel == pixel)
        return;
    Accumulated total = accumulation[pixel];
    for (uint i = index; i < params.sample_count && samples[i].pixel == pixel; ++i) {
        total.sum += samples[i].radiance;
        total.count += 1u;
    }
    accumulation[pixel] = total;
}

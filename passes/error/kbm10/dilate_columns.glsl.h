// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 extent;
    uint radius;
};
HONE_PARAMS(Params)
HONE_READ(uint, penumbra)
HONE_READ(uint, dilated_rows)
HONE_WRITE(vec2, error)

/// 1 where a pixel up to `radius` above or below is penumbra, and light can arrive at all.
void kernel(uint index) {
    int width = int(params.extent.x);
    int height = int(params.extent.y);
    int y = int(index) / width;
    int radius = int(params.radius);
    uint greatest = 0u;
    for (int other = max(y - radius, 0); other <= min(y + radius, height - 1); ++other)
        greatest = max(greatest, dilated_rows[int(index) + (other - y) * width]);
    error[index] = vec2(greatest == 2u && penumbra[index] > 0u ? 1.0f : 0.0f);
}

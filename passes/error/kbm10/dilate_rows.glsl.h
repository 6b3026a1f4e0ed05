// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 extent;
    uint radius;
};
HONE_PARAMS(Params)
HONE_READ(uint, penumbra)
HONE_WRITE(uint, dilated_rows)

/// The greatest of the pixels up to `radius` to the left and right.
void kernel(uint index) {
    int width = int(params.extent.x);
    int x = int(index) % width;
    int radius = int(params.radius);
    uint greatest = 0u;
    for (int other = max(x - radius, 0); other <= min(x + radius, width - 1); ++other)
        greatest = max(greatest, penumbra[int(index) - x + other]);
    dilated_rows[index] = greatest;
}

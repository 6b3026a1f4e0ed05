// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint unused;
};
HONE_PARAMS(Params)
HONE_READ(uvec2, triangle_ids)
HONE_WRITE(uvec2, hits)

/// The rasteriser wrote a triangle's place in the draw list; what it is called comes after.
void kernel(uint index) {
    uint place = hits[index].x;
    if (place != kNone)
        hits[index] = triangle_ids[place];
}

// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 extent;
    uvec2 tiles;
    uint tile; ///< side in pixels
    float radius_limit;
};
HONE_PARAMS(Params)
HONE_READ(float, confusion)
HONE_WRITE(float, blur_tiles)
HONE_WRITE(uint, limited)

/// A tile's greatest radius, and how many of its pixels the limit held back.
void kernel(uint index) {
    uint first_x = index % params.tiles.x * params.tile;
    uint first_y = index / params.tiles.x * params.tile;
    float greatest = 0.0f;
    uint count = 0u;
    for (uint y = first_y; y < min(first_y + params.tile, params.extent.y); ++y) {
        for (uint x = first_x; x < min(first_x + params.tile, params.extent.x); ++x) {
            float radius = 0.5f * abs(confusion[y * params.extent.x + x]);
            greatest = max(greatest, min(radius, params.radius_limit));
            count += radius > params.radius_limit ? 1u : 0u;
        }
    }
    blur_tiles[index] = greatest;
    limited[index] = count;
}

// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 tiles;
    uint tile; ///< side in pixels
    float radius_limit;
};
HONE_PARAMS(Params)
HONE_READ(float, blur_tiles)
HONE_WRITE(float, blur_reach)

/// Pixels between the nearest of two tiles that are `tiles` apart on one axis.
int pixelsBetween(int tiles) {
    return abs(tiles) == 0 ? 0 : (abs(tiles) - 1) * int(params.tile) + 1;
}

/// The greatest radius of the tiles whose pixels may spread into this one.
void kernel(uint index) {
    int x = int(index % params.tiles.x);
    int y = int(index / params.tiles.x);
    int range = int(params.radius_limit + 0.5f) / int(params.tile) + 1;
    float reach = 0.0f;
    for (int other_y = max(y - range, 0); other_y <= min(y + range, int(params.tiles.y) - 1);
         ++other_y) {
        for (int other_x = max(x - range, 0); other_x <= min(x + range, int(params.tiles.x) - 1);
             ++other_x) {
            float radius = blur_tiles[other_y * int(params.tiles.x) + other_x];
            float dx = float(pixelsBetween(other_x - x));
            float dy = float(pixelsBetween(other_y - y));
            if (dx * dx + dy * dy < (radius + 0.5f) * (radius + 0.5f))
                reach = max(reach, radius);
        }
    }
    blur_reach[index] = reach;
}

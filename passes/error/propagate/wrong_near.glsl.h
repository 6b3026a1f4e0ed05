// SPDX-License-Identifier: Apache-2.0

struct Params {
    uvec2 tiles;
    uint tile; ///< side in pixels
};
HONE_PARAMS(Params)
HONE_READ(uint, wrong_tiles)
HONE_READ(float, blur_reach)
HONE_WRITE(uint, wrong_near)

/// 1 for a tile that an error may be blurred into.
void kernel(uint index) {
    int x = int(index % params.tiles.x);
    int y = int(index / params.tiles.x);
    int pixels = int(floor(blur_reach[index] + 0.5f)); // as far as blurTaps() looks
    int range = (pixels + int(params.tile) - 1) / int(params.tile);
    uint found = 0u;
    for (int other_y = max(y - range, 0); other_y <= min(y + range, int(params.tiles.y) - 1);
         ++other_y) {
        for (int other_x = max(x - range, 0); other_x <= min(x + range, int(params.tiles.x) - 1);
             ++other_x)
            found = max(found, wrong_tiles[other_y * int(params.tiles.x) + other_x]);
    }
    wrong_near[index] = found;
}

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/shading/sanitised.glsl.h"

#include "hone/passes/error/propagate/clean_error.glsl.h"

struct Params {
    uvec2 extent;
    uvec2 tiles;
    uint tile; ///< side in pixels
};
HONE_PARAMS(Params)
HONE_READ(vec2, shading_error)
HONE_WRITE(vec2, clean)
HONE_WRITE(uint, wrong_tiles)

/// Cleans the errors of a tile; 1 for one that has any.
void kernel(uint index) {
    uint first_x = index % params.tiles.x * params.tile;
    uint first_y = index / params.tiles.x * params.tile;
    uint found = 0u;
    for (uint y = first_y; y < min(first_y + params.tile, params.extent.y); ++y) {
        for (uint x = first_x; x < min(first_x + params.tile, params.extent.x); ++x) {
            vec2 error = cleanError(shading_error[y * params.extent.x + x]);
            clean[y * params.extent.x + x] = error;
            if (error.x + error.y > 0.0f)
                found = 1u;
        }
    }
    wrong_tiles[index] = found;
}

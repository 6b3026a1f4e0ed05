// SPDX-License-Identifier: Apache-2.0
#pragma hone doc "How wrong one sample is where the picture has an edge: silhouettes, borders of shadows, fine texture."
#pragma hone in Radiance color "the raster image, one sample a pixel"
#pragma hone out Error error "a share of the step that the edge makes, and the whole of it"
#pragma hone param float share = 0.0625 min 0 max 1 "of the step, that a pixel next to it is wrong by"

void main() {
    float least = luminance(color[index]);
    float most = least;
    for (int i = 0; i < 9; ++i) {
        float there = luminance(color[neighbour(i % 3 - 1, i / 3 - 1)]);
        least = min(least, there);
        most = max(most, there);
    }
    // The traced pixel is a mean over its square: it lies between what is seen around it.
    error = vec2(share, 1) * (most - least);
}

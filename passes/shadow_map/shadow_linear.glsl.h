// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint first;        ///< texel to begin with
    float near;        ///< of a perspective face
    float depth_range; ///< > 0: orthographic, metres from front to back
};
HONE_PARAMS(Params)
HONE_WRITE(float, maps)

/// Depth buffer values (reversed) become depths along the face's axis in metres, 1e30 for nothing.
void kernel(uint index) {
    float depth = maps[params.first + index];
    float linear = 1e30f;
    if (depth > 0.0f)
        linear =
            params.depth_range > 0.0f ? (1.0f - depth) * params.depth_range : params.near / depth;
    maps[params.first + index] = linear;
}

// SPDX-License-Identifier: Apache-2.0
//
// Looking up the environment cube maps that pass environment_probe makes. The record describes
// itself: environment_maps[0] = (size of a face in texels, number of probes, 0, 0); then, by probe
// and face, size x size texels of (radiance, distance from the probe to what is seen; 1e30 =
// nothing). Kernel source: included flat, once, inside a kernel, after cube.glsl.h.

HONE_READ(vec4, environment_maps)

/// Radiance (xyz) and distance (w) that the probe saw along `direction`: bilinear inside the face.
vec4 environmentMap(uint probe, vec3 direction) {
    uint size = uint(environment_maps[0].x);
    uint face = cubeFace(direction);
    vec2 position = cubePosition(cubeCoordinates(face, direction), size);
    float x = clamp(position.x - 0.5f, 0.0f, float(size) - 1.0f);
    float y = clamp(position.y - 0.5f, 0.0f, float(size) - 1.0f);
    uint x0 = uint(x);
    uint y0 = uint(y);
    uint x1 = x0 + 1u < size ? x0 + 1u : x0;
    uint y1 = y0 + 1u < size ? y0 + 1u : y0;
    float fx = x - float(x0);
    float fy = y - float(y0);
    uint first = 1u + (probe * 6u + face) * size * size;
    vec4 top =
        mix(environment_maps[first + y0 * size + x0], environment_maps[first + y0 * size + x1], fx);
    vec4 bottom =
        mix(environment_maps[first + y1 * size + x0], environment_maps[first + y1 * size + x1], fx);
    return mix(top, bottom, fy);
}

// SPDX-License-Identifier: Apache-2.0
//
// Random numbers that depend on their index only, so that a sample is the same whoever draws it
// first. Kernel source: included flat, once, inside a kernel (kernel.glsl.h).

/// Four hashed words from four (pcg4d of Jarzynski and Olano, Hash Functions for GPU Rendering,
/// JCGT 9(3), 2020).
uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// The upper 24 bits as a number in [0,1).
float unitFloat(uint bits) {
    return float(bits >> 8u) * (1.0f / 16777216.0f);
}

/// Point `index` of a two-dimensional (0,2)-sequence, the first two dimensions of Sobol's, with
/// digits flipped by `scramble`: any 2^k points that begin at a multiple of 2^k are stratified in
/// all ways that 2^k cells allow. (Kollig and Keller, Efficient Multidimensional Sampling, 2002.)
uvec2 scrambledSobol(uint index, uvec2 scramble) {
    uvec2 bits = scramble;
    uint second = 0x80000000u;
    for (uint first = 0x80000000u; index != 0u; first = first >> 1u) {
        if ((index & 1u) != 0u)
            bits = bits ^ uvec2(first, second);
        second = second ^ (second >> 1u);
        index = index >> 1u;
    }
    return bits;
}

// SPDX-License-Identifier: Apache-2.0
//
// What the kernels of trace hand on. Kernel source: included flat, once, inside a kernel.

/// A path that waits for what its ray sees.
struct Path {
    vec3 throughput; ///< what it weighs in its sample
    float traveled;  ///< metres so far; for the primary ray view depth, which its pixel's cone has
    uint ray;        ///< whose hit it sees; samples of one request share a pinhole's primary ray
    uint slot;       ///< where its sample is in the list
    uint pixel;
    uint sample_number; ///< of its pixel
};

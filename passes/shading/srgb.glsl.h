// SPDX-License-Identifier: Apache-2.0
//
// From linear to display values, for tonemap and whoever compares what a screen shows.
// Kernel source: included flat, once, inside a kernel.

/// The sRGB transfer function (IEC 61966-2-1), for x in [0,1].
float encodeSrgb(float x) {
    return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}

// SPDX-License-Identifier: Apache-2.0
//
// Kernel source: included flat, once, inside a kernel (kernel.glsl.h).

/// Neither NaN nor infinity, which no comparison tells on every device.
bool isFinite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

/// What an error must be: NaN and infinity say that a metric failed and count as 1, never as 0;
/// what is negative is 0.
float sanitised(float x) {
    if (!isFinite(x))
        return 1.0f;
    return x > 0.0f ? x : 0.0f;
}

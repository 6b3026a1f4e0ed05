// SPDX-License-Identifier: Apache-2.0
//
// How far a pixel is from the truth. Kernel source: included flat, once, inside a kernel
// (kernel.glsl.h), after its
//     float shown(float radiance)   a channel as it is compared

bool isFinite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

/// |a - b| as they are shown; 0 for the same bits, 1 where one of them is not a number that can be
/// compared.
float channelError(float a, float b) {
    if (floatBitsToUint(a) == floatBitsToUint(b))
        return 0.0f;
    float difference = abs(shown(a) - shown(b));
    return isFinite(a) && isFinite(b) && isFinite(difference) ? difference : 1.0f;
}

vec3 channelErrors(vec3 a, vec3 b) {
    return vec3(channelError(a.x, b.x), channelError(a.y, b.y), channelError(a.z, b.z));
}

float greatest(vec3 errors) {
    return max(max(errors.x, errors.y), errors.z);
}

/// Its mean over an image is the MSE.
float meanSquare(vec3 errors) {
    return (errors.x * errors.x + errors.y * errors.y + errors.z * errors.z) * (1.0f / 3.0f);
}

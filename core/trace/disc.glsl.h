// SPDX-License-Identifier: Apache-2.0
//
// Kernel source: included flat, once, inside a kernel (kernel.glsl.h).

/// The square [-1,1]^2 onto the unit disc, shares of area kept (Shirley and Chiu, A Low Distortion
/// Map Between Disk and Square, 1997).
vec2 discFromSquare(vec2 square) {
    if (square.x == 0.0f && square.y == 0.0f)
        return vec2(0.0f);
    bool is_flat = abs(square.x) > abs(square.y);
    float radius = is_flat ? square.x : square.y;
    float angle = is_flat ? 0.785398163f * (square.y / square.x)
                          : 1.570796327f - 0.785398163f * (square.x / square.y);
    return radius * vec2(cos(angle), sin(angle));
}

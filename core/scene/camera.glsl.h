// SPDX-License-Identifier: Apache-2.0
//
// The one place where a pixel becomes a ray, for raster and trace alike.
// Kernel source: included flat, once, inside a kernel (kernel.glsl.h), after the records.

/// The ray through `position` in pixels (the centre of pixel (x, y) is (x + 0.5, y + 0.5), y down).
/// The direction is not normalised: its component along camera.forward is 1, so t is view depth.
Ray cameraRay(Camera camera, uvec2 extent, vec2 position) {
    float x = (2.0f * position.x - float(extent.x)) / float(extent.y);
    float y = (float(extent.y) - 2.0f * position.y) / float(extent.y);
    Ray ray;
    ray.origin = camera.position;
    ray.tmin = camera.near;
    ray.direction = camera.forward + camera.tan_half_fov_y * (x * camera.right + y * camera.up);
    ray.tmax = 1e30f;
    return ray;
}

vec2 pixelCenter(uint pixel, uvec2 extent) {
    return vec2(float(pixel % extent.x) + 0.5f, float(pixel / extent.x) + 0.5f);
}

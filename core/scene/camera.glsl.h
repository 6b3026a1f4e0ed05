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

/// The ray that leaves a thin lens at `lens`, a point of the unit disc, for the point in the plane
/// of focus that cameraRay() sees through `position`. t is view depth here, too.
Ray lensRay(Camera camera, uvec2 extent, vec2 position, vec2 lens) {
    Ray ray = cameraRay(camera, extent, position);
    vec3 offset = camera.lens_radius * (lens.x * camera.right + lens.y * camera.up);
    ray.origin += offset;
    ray.direction = ray.direction - (1.0f / camera.focus) * offset;
    return ray;
}

/// The diameter in pixels of the disc that a point at view depth `depth` is blurred to, negative in
/// front of the plane of focus: aperture * focal length in pixels * (1 / focus - 1 / depth). A
/// depth of 0 is that of a pixel that sees nothing: infinitely far. Nothing is blurred as if it
/// were nearer than a picometre, so diameters and their squares are finite. Source: Potmesil and
/// Chakravarty, A Lens and Aperture Camera Model for Synthetic Image Generation, 1981; their lens's
/// focal length cancels out, for the sensor lies where it images the plane of focus.
float circleOfConfusion(Camera camera, uvec2 extent, float depth) {
    float focal_length = float(extent.y) / (2.0f * camera.tan_half_fov_y);
    float inverse_depth = depth > 0.0f ? min(1.0f / depth, 1e12f) : 0.0f;
    return 2.0f * camera.lens_radius * focal_length * (1.0f / camera.focus - inverse_depth);
}

vec2 pixelCenter(uint pixel, uvec2 extent) {
    return vec2(float(pixel % extent.x) + 0.5f, float(pixel / extent.x) + 0.5f);
}

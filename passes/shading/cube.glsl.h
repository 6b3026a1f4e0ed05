// SPDX-License-Identifier: Apache-2.0
//
// Cube maps in linear buffers: which face and texel a direction falls on, and back.
// Faces +x -x +y -y +z -z; a texel's row runs along `down`, its column along `right` of the face.
// Kernel source: included flat, once, inside a kernel.

vec3 cubeForward(uint face) {
    float side = (face & 1u) == 0u ? 1.0f : -1.0f;
    uint axis = face >> 1u;
    return vec3(axis == 0u ? side : 0.0f, axis == 1u ? side : 0.0f, axis == 2u ? side : 0.0f);
}

vec3 cubeUp(uint face) {
    return (face >> 1u) == 1u ? vec3(0.0f, 0.0f, -1.0f) : vec3(0.0f, 1.0f, 0.0f);
}

vec3 cubeRight(uint face) {
    return cross(cubeForward(face), cubeUp(face));
}

uint cubeFace(vec3 direction) {
    vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z)
        return direction.x >= 0.0f ? 0u : 1u;
    if (size.y >= size.z)
        return direction.y >= 0.0f ? 2u : 3u;
    return direction.z >= 0.0f ? 4u : 5u;
}

/// The direction's components along the face's right, up and forward.
vec3 cubeCoordinates(uint face, vec3 direction) {
    float side = (face & 1u) == 0u ? 1.0f : -1.0f;
    uint axis = face >> 1u;
    if (axis == 0u)
        return vec3(side * direction.z, direction.y, side * direction.x);
    if (axis == 1u)
        return vec3(-side * direction.x, -direction.z, side * direction.y);
    return vec3(-side * direction.x, direction.y, side * direction.z);
}

/// Where a direction, by its components on a face, meets the face: in texels from the top left
/// corner, [0,size] each way.
vec2 cubePosition(vec3 coordinates, uint size) {
    float x = coordinates.x / coordinates.z;
    float y = coordinates.y / coordinates.z;
    return vec2((0.5f + 0.5f * x) * float(size), (0.5f - 0.5f * y) * float(size));
}

/// The direction (component along the face's axis 1) through a position in texels.
vec3 cubeDirection(uint face, vec2 position, uint size) {
    float x = 2.0f * position.x / float(size) - 1.0f;
    float y = 1.0f - 2.0f * position.y / float(size);
    return cubeForward(face) + x * cubeRight(face) + y * cubeUp(face);
}

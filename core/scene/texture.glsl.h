// SPDX-License-Identifier: Apache-2.0
//
// Textures, filtered by hand from a linear buffer so that host and device, raster and trace read
// the same values. Kernel source: included flat, once, inside a kernel (kernel.glsl.h).

HONE_READ(Texture, scene_textures)
HONE_READ(uint, scene_texels)
HONE_READ(float, scene_srgb) // decoded value of each 8-bit sRGB code

/// A texel's row or column after wrapping (Texture::wrap_u), for an i at most one texel outside the
/// period that textureQuad() keeps. Whatever i is, the result is inside the texture.
uint wrapTexel(int i, uint size, uint mode) {
    int n = int(size);
    int period = mode == 2u ? 2 * n : n;
    int m = i;
    if (mode != 1u) {
        m = i < 0 ? i + period : i;
        m = m >= period ? m - period : m;
        m = m < n ? m : period - 1 - m;
    }
    return uint(clamp(m, 0, n - 1));
}

/// The four texels around a point, as indices into scene_texels, and where the point lies between
/// them.
struct TexelQuad {
    uint top_left;
    uint top_right;
    uint bottom_left;
    uint bottom_right;
    float x;
    float y;
};

/// A coordinate in texels of `size`, without its whole turns: a float keeps its fraction then, and
/// an int stays in range.
float texelCoordinate(float u, uint size, uint mode) {
    float turns = mode == 2u ? 2.0f * floor(0.5f * u) : floor(u);
    float inside = mode == 1u ? clamp(u, 0.0f, 1.0f) : u - turns;
    return inside * float(size) - 0.5f;
}

TexelQuad textureQuad(Texture texture_info, vec2 uv, uint level) {
    uint first = texture_info.first_texel;
    uint width = texture_info.width;
    uint height = texture_info.height;
    for (uint i = 0u; i < level; ++i) {
        first += width * height;
        width = max(1u, width / 2u);
        height = max(1u, height / 2u);
    }
    float x = texelCoordinate(uv.x, width, texture_info.wrap_u);
    float y = texelCoordinate(uv.y, height, texture_info.wrap_v);
    int column = int(floor(x));
    int row = int(floor(y));
    uint left = wrapTexel(column, width, texture_info.wrap_u);
    uint right = wrapTexel(column + 1, width, texture_info.wrap_u);
    uint top = first + width * wrapTexel(row, height, texture_info.wrap_v);
    uint bottom = first + width * wrapTexel(row + 1, height, texture_info.wrap_v);
    TexelQuad quad;
    quad.top_left = top + left;
    quad.top_right = top + right;
    quad.bottom_left = bottom + left;
    quad.bottom_right = bottom + right;
    quad.x = x - floor(x);
    quad.y = y - floor(y);
    return quad;
}

/// A texel's linear RGB and alpha.
vec4 decodeTexel(uint texel) {
    return vec4(scene_srgb[texel & 255u], scene_srgb[(texel >> 8u) & 255u],
                scene_srgb[(texel >> 16u) & 255u], float(texel >> 24u) * (1.0f / 255.0f));
}

/// Bilinear lookup at one mip level: linear RGB and alpha. (0,0) is the corner of the top left
/// texel.
vec4 textureBilinear(Texture texture_info, vec2 uv, uint level) {
    TexelQuad quad = textureQuad(texture_info, uv, level);
    return (1.0f - quad.y) * ((1.0f - quad.x) * decodeTexel(scene_texels[quad.top_left]) +
                              quad.x * decodeTexel(scene_texels[quad.top_right])) +
           quad.y * ((1.0f - quad.x) * decodeTexel(scene_texels[quad.bottom_left]) +
                     quad.x * decodeTexel(scene_texels[quad.bottom_right]));
}

/// The alpha of textureBilinear() at the base level, alone.
float textureAlpha(Texture texture_info, vec2 uv) {
    TexelQuad quad = textureQuad(texture_info, uv, 0u);
    float top = (1.0f - quad.x) * float(scene_texels[quad.top_left] >> 24u) +
                quad.x * float(scene_texels[quad.top_right] >> 24u);
    float bottom = (1.0f - quad.x) * float(scene_texels[quad.bottom_left] >> 24u) +
                   quad.x * float(scene_texels[quad.bottom_right] >> 24u);
    return ((1.0f - quad.y) * top + quad.y * bottom) * (1.0f / 255.0f);
}

/// Trilinear lookup; `lod` counts levels from the base and is clamped to those there are. NaN
/// counts as 0.
vec4 textureTrilinear(uint texture_index, vec2 uv, float lod) {
    Texture texture_info = scene_textures[texture_index];
    float top_level = float(texture_info.levels - 1u);
    float clamped = lod > 0.0f ? min(lod, top_level) : 0.0f;
    uint level = uint(clamped);
    float blend = clamped - float(level);
    vec4 fine = textureBilinear(texture_info, uv, level);
    if (blend == 0.0f)
        return fine;
    return mix(fine, textureBilinear(texture_info, uv, level + 1u), blend);
}

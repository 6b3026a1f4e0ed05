// SPDX-License-Identifier: Apache-2.0
//
// Which part of a light is hidden: 16 x 16 cells of a rectangle around it, a bit each (Schwarz and
// Stamminger, Bitmask Soft Shadows, 2007). The rectangle's sides are the map's rows and columns, so
// that what its texels cover has no gaps and no overlaps. Kernel source: included flat, once,
// inside a kernel, after light_cone.glsl.h.

HONE_CONST int kMaskEdge = 16;
uint hidden_rows[16]; ///< by v; bit by u

/// Half the rectangle's sides, as vectors and by the light's own two axes.
struct MaskFrame {
    vec3 half_u;
    vec3 half_v;
    vec2 by_u;
    vec2 by_v;
};

/// Around the light as a face sees it.
MaskFrame maskFrame(Light light, LightExtent extent, uint face, ShadowLookup tip) {
    vec2 u = coneSlope(tip, onFace(light, face, extent.half_u), false);
    vec2 v = coneSlope(tip, onFace(light, face, extent.half_v), false);
    vec2 reach =
        extent.is_round ? vec2(length(vec2(u.x, v.x)), length(vec2(u.y, v.y))) : abs(u) + abs(v);
    float determinant = u.x * v.y - u.y * v.x;
    float inverse = determinant == 0.0f ? 0.0f : 1.0f / determinant;
    MaskFrame frame;
    frame.by_u = reach.x * inverse * vec2(v.y, -u.y);
    frame.by_v = reach.y * inverse * vec2(-v.x, u.x);
    frame.half_u = frame.by_u.x * extent.half_u + frame.by_u.y * extent.half_v;
    frame.half_v = frame.by_v.x * extent.half_u + frame.by_v.y * extent.half_v;
    return frame;
}

/// From slopes in a face back to the mask's square.
struct MaskView {
    vec2 to_u;
    vec2 to_v;
    vec2 reach; ///< of a square of half edge 1
};

/// Where the mask's axes are askew to the face's (it is laid out for another), the image of a
/// square is replaced by the rectangle of its size and proportions.
MaskView maskView(Light light, MaskFrame frame, uint face, ShadowLookup tip) {
    vec2 u = coneSlope(tip, onFace(light, face, frame.half_u), false);
    vec2 v = coneSlope(tip, onFace(light, face, frame.half_v), false);
    float determinant = u.x * v.y - u.y * v.x;
    float inverse = determinant == 0.0f ? 0.0f : 1.0f / determinant;
    MaskView view;
    view.to_u = inverse * vec2(v.y, -v.x);
    view.to_v = inverse * vec2(-u.y, u.x);
    view.reach = vec2(abs(view.to_u.x) + abs(view.to_u.y), abs(view.to_v.x) + abs(view.to_v.y));
    view.reach *= sqrt(abs(inverse) / max(view.reach.x * view.reach.y, 1e-30f));
    return view;
}

void clearMask() {
    for (int row = 0; row < kMaskEdge; ++row)
        hidden_rows[row] = 0u;
}

float maskCenter(int cell) {
    return (float(cell) + 0.5f) * (2.0f / float(kMaskEdge)) - 1.0f;
}

/// The first cell whose centre is not before `at`; the first of all for NaN.
int maskCell(float at) {
    float cell = (at + 1.0f) * (0.5f * float(kMaskEdge)) - 0.5f;
    if (!(cell > 0.0f))
        return 0;
    return cell >= float(kMaskEdge) ? kMaskEdge : int(ceil(cell));
}

/// Hides what a square of that nearness covers, projected from the cone's tip back onto the light.
void hideArea(LightCone cone, MaskView view, Area area, float nearness) {
    float way = nearness - cone.nearness;
    if (way <= 0.0f)
        return;
    vec2 off = 0.5f * (area.low + area.high) - cone.tip.position;
    vec2 middle = vec2(dot(view.to_u, off), dot(view.to_v, off)) / way;
    vec2 reach = 0.5f * (area.high.x - area.low.x) / way * view.reach;
    int left = maskCell(middle.x - reach.x);
    int right = maskCell(middle.x + reach.x);
    int top = maskCell(middle.y - reach.y);
    int bottom = maskCell(middle.y + reach.y);
    uint bits = ((1u << uint(right)) - 1u) & ~((1u << uint(left)) - 1u);
    for (int row = top; row < bottom; ++row)
        hidden_rows[row] = hidden_rows[row] | bits;
}

/// Hides what is below the horizon of a plane: `center` is the height above it of the light's
/// centre, `u` and `v` how that grows along its axes.
void hideBelow(float center, float u, float v) {
    for (int row = 0; row < kMaskEdge; ++row)
        for (int column = 0; column < kMaskEdge; ++column)
            if (center + maskCenter(column) * u + maskCenter(row) * v <= 0.0f)
                hidden_rows[row] = hidden_rows[row] | (1u << uint(column));
}

/// Which cells of a row are the light's.
uint lightCells(MaskFrame frame, bool is_round, float v) {
    vec2 start = v * frame.by_v;
    vec2 along = frame.by_u;
    float from = -1.0f;
    float to = 1.0f;
    if (is_round) {
        float a = dot(along, along);
        float b = dot(start, along);
        float root = b * b - a * (dot(start, start) - 1.0f);
        if (root <= 0.0f)
            return 0u;
        from = (-b - sqrt(root)) / a;
        to = (-b + sqrt(root)) / a;
    } else {
        for (int axis = 0; axis < 2; ++axis) {
            float at = axis == 0 ? start.x : start.y;
            float slope = axis == 0 ? along.x : along.y;
            if (abs(slope) < 1e-6f) {
                if (abs(at) > 1.0f)
                    return 0u;
                continue;
            }
            float one = (-1.0f - at) / slope;
            float other = (1.0f - at) / slope;
            from = max(from, min(one, other));
            to = min(to, max(one, other));
        }
        if (from >= to)
            return 0u;
    }
    return ((1u << uint(maskCell(to))) - 1u) & ~((1u << uint(maskCell(from))) - 1u);
}

/// The share of the light that is left.
float visibleShare(MaskFrame frame, bool is_round) {
    int cells = 0;
    int hidden = 0;
    for (int row = 0; row < kMaskEdge; ++row) {
        uint inside = lightCells(frame, is_round, maskCenter(row));
        cells += int(bitCount(inside));
        hidden += int(bitCount(inside & hidden_rows[row]));
    }
    return cells == 0 ? 0.5f : 1.0f - float(hidden) / float(cells);
}

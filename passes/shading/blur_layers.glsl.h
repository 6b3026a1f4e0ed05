// SPDX-License-Identifier: Apache-2.0
//
// Depth of field's arithmetic: how a pixel's disc of confusion counts for another, and what the
// layers that it ends in become. Written for whatever
//     BlurReal   float, or several pixels' (lanes.h)
//     BlurMask   bool likewise
//     BlurColor  what is blurred: a sum of them, and BlurReal * BlurColor
// are. Kernel source: included flat, once, after those.

BlurReal blurRadius(BlurReal diameter, float radius_limit) {
    return clamp(0.5f * abs(diameter), 0.5f, radius_limit);
}

/// One by how many pixels a disc covers.
BlurReal inverseArea(BlurReal radius) {
    return 1.0f / (3.14159265f * (radius * radius + 0.0833333f));
}

/// How far a disc covers a pixel `away` from its middle: its rim is a pixel wide, so that the sum
/// over all pixels is the area. A radius of 1/2 is a pixel that keeps all to itself.
BlurReal discCover(BlurReal radius, float away) {
    return clamp(radius - away + 0.5f, 0.0f, 1.0f);
}

/// What a pixel spreads over.
struct BlurDisc {
    BlurReal diameter; ///< signed
    BlurReal radius;
    BlurReal inverse_area;
};

BlurDisc blurDisc(BlurReal diameter, float radius_limit) {
    BlurDisc disc;
    disc.diameter = diameter;
    disc.radius = blurRadius(diameter, radius_limit);
    disc.inverse_area = inverseArea(disc.radius);
    return disc;
}

/// The surface that a pixel shows.
struct BlurSurface {
    BlurDisc disc;
    BlurReal slope_x;           ///< how much the diameter grows per pixel to the right
    BlurReal slope_y;           ///< and down
    BlurReal inverse_tolerance; ///< surfaces whose blur differs by more than one over this are two
};

/// What blurs by less than a pixel more or less, or an eighth, is the same surface anyway.
BlurReal inverseTolerance(BlurReal diameter) {
    return 1.0f / max(1.0f, 0.125f * abs(diameter));
}

/// From a pixel to one around it.
struct BlurStep {
    float dx;
    float dy;
    float away; ///< pixels
};

BlurStep blurStep(int dx, int dy) {
    BlurStep result;
    result.dx = float(dx);
    result.dy = float(dy);
    result.away = sqrt(result.dx * result.dx + result.dy * result.dy);
    return result;
}

/// Whether the discs of p and of a pixel around it are too small for the two to touch.
BlurMask isOutOfReach(BlurSurface surface, BlurDisc disc, BlurStep off) {
    BlurReal reach = max(surface.disc.radius, disc.radius) + 0.5f;
    return off.dx * off.dx + off.dy * off.dy >= reach * reach;
}

/// How much farther than p's surface a pixel lies, in pixels of blur: measured from its plane and
/// from its depth, whichever is nearer, for both are the same surface.
BlurReal blurBehind(BlurReal difference, BlurReal slope) {
    BlurReal from_plane = difference - slope;
    BlurReal nearer = abs(difference) < abs(from_plane) ? difference : from_plane;
    return difference * from_plane <= 0.0f ? 0.0f : nearer;
}

/// How a pixel counts for another, p. It is in one of three layers, or between two of them.
struct BlurShare {
    BlurReal spread;   ///< what it spreads to p
    BlurReal open;     ///< its part of p's own disc
    BlurReal is_front; ///< in front of p's surface, as a part of 1
    BlurReal is_own;
    BlurReal is_behind;
};

BlurShare blurShare(BlurSurface surface, BlurDisc disc, BlurStep off) {
    BlurShare share;
    share.spread = discCover(disc.radius, off.away) * disc.inverse_area;
    share.open = discCover(surface.disc.radius, off.away) * surface.disc.inverse_area;
    BlurReal farther = blurBehind(disc.diameter - surface.disc.diameter,
                                  surface.slope_x * off.dx + surface.slope_y * off.dy) *
                       surface.inverse_tolerance;
    share.is_front = clamp(-farther - 1.0f, 0.0f, 1.0f);
    share.is_behind = clamp(farther - 1.0f, 0.0f, 1.0f);
    share.is_own = 1.0f - share.is_front - share.is_behind;
    return share;
}

/// Where nothing behind spreads to p, the nearest of it that p's disc lays open will do.
BlurReal fillWeight(BlurShare share, BlurStep off) {
    float nearness = 1e-4f / (1.0f + off.away * off.away);
    return share.is_behind * (share.spread + nearness * share.open);
}

/// What arrives at a pixel, by layer.
struct BlurLayers {
    BlurColor front;
    BlurColor own;
    BlurColor behind;
    BlurReal front_weight;
    BlurReal own_weight;
    BlurReal behind_weight;
    BlurReal open_weight;
    BlurReal arrivals; ///< pixels that anything came from
};

void addToLayers(HONE_INOUT(BlurLayers) layers, BlurShare share, BlurStep off, BlurColor color) {
    BlurReal front = share.is_front * share.spread;
    BlurReal own = share.is_own * share.spread;
    BlurReal behind = fillWeight(share, off);
    layers.front += front * color;
    layers.own += own * color;
    layers.behind += behind * color;
    layers.front_weight += front;
    layers.own_weight += own;
    layers.behind_weight += behind;
    layers.open_weight += share.is_behind * share.open;
    BlurReal arrives = (1.0f - share.is_behind) * share.spread + share.is_behind * share.open;
    layers.arrivals += arrives > 0.0f ? 1.0f : 0.0f;
}

/// A channel of the layers, laid over each other; `tap_area`: pixels that one of those that were
/// added stands for. The surface's weight is never 0, for p is of it.
BlurReal laidOver(BlurLayers layers, BlurReal front, BlurReal own, BlurReal behind,
                  float tap_area) {
    BlurReal surface = own / layers.own_weight;
    BlurReal closed = layers.own_weight / (layers.own_weight + layers.open_weight);
    BlurReal opened = closed * surface + (1.0f - closed) * (behind / layers.behind_weight);
    BlurReal result = layers.open_weight > 0.0f ? opened : surface;
    BlurReal covers = min(layers.front_weight * tap_area, 1.0f);
    BlurReal covered = covers * (front / layers.front_weight) + (1.0f - covers) * result;
    return layers.front_weight > 0.0f ? covered : result;
}

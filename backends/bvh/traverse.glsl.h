// SPDX-License-Identifier: Apache-2.0
//
// The traversal of a BVH (bvh.glsl.h) without a stack. Kernel source: included flat by the kernels
// beside it, after surface.glsl.h.
//
// Loops are nested by how often they turn, because software devices run through every `if`: boxes
// and triangles inside, what happens rarely (holes of masks, instances) outside. Keeping a
// subgroup's rays at one node, so that they share loads, was tried: on Mesa 25 it costs 5 to 30 %
// where it was meant to gain, and on Mesa 22 it gains 10 % for primary rays alone.

struct Params {
    uint first_ray; ///< where the list begins in the bound buffers
    uint first_answer;
    uint node_count;
    uint step_limit; ///< boxes and triangles that a dispatch tests at most for a ray, roughly
    uint is_resumed; ///< 1: go on from bvh_states
    float extent;    ///< the greatest coordinate in the world's tree, without sign
};
HONE_PARAMS(Params)
HONE_READ(Ray, rays)
HONE_READ(BvhNode, bvh_nodes)
HONE_READ(uint, bvh_skips) // by octant, then by node; kNone: the tree ends
HONE_READ(BvhTriangle, bvh_triangles)
HONE_READ(BvhInstance, bvh_instances)
HONE_WRITE(BvhState, bvh_states)
HONE_WRITE(uint, bvh_unfinished) // one word: not 0 if a ray is

/// A ray in the space of the tree that is traversed.
struct Lane {
    vec3 origin;
    vec3 direction;
    vec3 inverse; ///< of the direction, finite
    float pad;    ///< what boxes are enlarged by
};

/// Boxes are enlarged so that rounding, of the slabs (Ize, Robust BVH Ray Traversal, JCGT 2(2),
/// 2013) and of crossing() below, never hides a triangle that the ray crosses: both err by a few
/// units in the last place of the coordinates' differences.
Lane makeLane(vec3 origin, vec3 direction, float extent) {
    const float limit = 1e20f; // times a coordinate it stays finite
    Lane lane;
    lane.origin = origin;
    lane.direction = direction;
    lane.inverse = vec3(direction.x == 0.0f ? limit : clamp(1.0f / direction.x, -limit, limit),
                        direction.y == 0.0f ? limit : clamp(1.0f / direction.y, -limit, limit),
                        direction.z == 0.0f ? limit : clamp(1.0f / direction.z, -limit, limit));
    float farthest = max(max(abs(origin.x), abs(origin.y)), abs(origin.z));
    lane.pad = (farthest + extent) * (1.0f / 1048576.0f);
    return lane;
}

bool meetsBox(Lane lane, BvhNode node, float tmin, float tmax) {
    vec3 middle = (node.center - lane.origin) * lane.inverse;
    vec3 reach = (node.half_size + vec3(lane.pad)) * abs(lane.inverse);
    vec3 first = middle - reach;
    vec3 last = middle + reach;
    return max(max(first.x, first.y), max(first.z, tmin)) <=
           min(min(last.x, last.y), min(last.z, tmax));
}

Lane placedLane(BvhInstance placed, vec3 origin, vec3 direction) {
    return makeLane(placed.to_object * vec4(origin, 1.0f), placed.to_object * vec4(direction, 0.0f),
                    placed.extent);
}

/// On which side of the line from `from` to `to` (as seen from its origin) a ray passes: the same
/// bits with the opposite sign for the line from `to` to `from`.
float sideOf(vec3 direction, vec3 from, vec3 to) {
    vec3 along = to - from;
    vec3 sum = to + from;
    HONE_PRECISE float x = along.y * sum.z - along.z * sum.y;
    HONE_PRECISE float y = along.z * sum.x - along.x * sum.z;
    HONE_PRECISE float z = along.x * sum.y - along.y * sum.x;
    HONE_PRECISE float side = direction.x * x + direction.y * y + direction.z * z;
    return side;
}

/// Whether and where a ray crosses a triangle: it passes the three edges on the same side (Pluecker
/// coordinates; Benthin 2006, section 4.1.3). Zero counts as inside, so that no ray slips between
/// neighbours. `slope` is positive where the back turns to the ray, counter-clockwise being front.
/// A triangle without area and one whose plane holds the ray are not crossed.
bool crossing(Lane lane, BvhTriangle triangle, HONE_OUT(float) t, HONE_OUT(float) slope) {
    vec3 a = triangle.a - lane.origin;
    vec3 b = triangle.b - lane.origin;
    vec3 c = triangle.c - lane.origin;
    float ab = sideOf(lane.direction, a, b);
    float bc = sideOf(lane.direction, b, c);
    float ca = sideOf(lane.direction, c, a);
    vec3 side_b = triangle.b - triangle.a;
    vec3 side_c = triangle.c - triangle.a;
    HONE_PRECISE float x = side_b.y * side_c.z - side_b.z * side_c.y;
    HONE_PRECISE float y = side_b.z * side_c.x - side_b.x * side_c.z;
    HONE_PRECISE float z = side_b.x * side_c.y - side_b.y * side_c.x;
    HONE_PRECISE float descent = lane.direction.x * x + lane.direction.y * y + lane.direction.z * z;
    HONE_PRECISE float height = a.x * x + a.y * y + a.z * z;
    slope = descent;
    t = height / descent;
    // NaN is on no side.
    return slope != 0.0f &&
           ((ab >= 0.0f && bc >= 0.0f && ca >= 0.0f) || (ab <= 0.0f && bc <= 0.0f && ca <= 0.0f));
}

/// What isTraceable (traceable.h) says, in the kernels' words.
bool canHit(Ray ray) {
    vec3 o = abs(ray.origin);
    vec3 d = abs(ray.direction);
    return max(max(o.x, o.y), o.z) < 1e18f && max(max(d.x, d.y), d.z) < 1e18f && o.x < 1e18f &&
           o.y < 1e18f && o.z < 1e18f && d.x < 1e18f && d.y < 1e18f && d.z < 1e18f &&
           max(max(d.x, d.y), d.z) > 0.0f && ray.tmin <= ray.tmax && ray.tmax >= 0.0f;
}

/// Which of the eight octants a direction points to, one bit an axis: set where it descends.
uint octantOf(vec3 direction) {
    return (direction.x < 0.0f ? 1u : 0u) | (direction.y < 0.0f ? 2u : 0u) |
           (direction.z < 0.0f ? 4u : 0u);
}

/// The octant in which an instance's tree is traversed by all rays of an octant of the world.
uint octantInside(BvhInstance placed, uint octant) {
    vec3 diagonal = vec3((octant & 1u) != 0u ? -1.0f : 1.0f, (octant & 2u) != 0u ? -1.0f : 1.0f,
                         (octant & 4u) != 0u ? -1.0f : 1.0f);
    return octantOf(placed.to_object * vec4(diagonal, 0.0f));
}

/// Finds the nearest hit of ray `index` (or, if `is_any_enough`, any) that comes before `best`,
/// from where bvh_states says if resumed. Returns whether there is one; `best` is then replaced.
bool traverse(uint index, bool is_any_enough, HONE_INOUT(Hit) best) {
    Ray ray = rays[params.first_ray + index];

    // In units of a direction whose longest component is between 1 and 2, so that no inverse
    // overflows: a power of two, which rounds nothing.
    vec3 lengths = abs(ray.direction);
    uint exponent =
        clamp(floatBitsToUint(max(max(lengths.x, lengths.y), lengths.z)) >> 23u, 1u, 253u);
    float unit = uintBitsToFloat(exponent << 23u);
    vec3 direction = ray.direction * uintBitsToFloat((254u - exponent) << 23u);
    float tmin = max(ray.tmin, 0.0f) * unit;
    float best_t = ray.tmax * unit;
    uint octant = octantOf(direction);

    Lane lane = makeLane(ray.origin, direction, params.extent);
    uint order = octant;                    // in the space of the tree
    uint skips = order * params.node_count; // where its links begin
    uint node = canHit(ray) ? 0u : kNone;   // the next to visit
    uint inside = kNone;   // the leaf whose instance is traversed; kNone: the world is
    uint leave_to = kNone; // where the world's tree goes on after the instance
    uint instance = kNone; // that triangles belong to; kNone: they say
    uint cursor = 0u;      // the next triangle of a leaf, up to
    uint last = 0u;
    uint steps = 0u;
    bool is_found = false;
    bool is_pending = false; // a hit that may be a hole
    float pending_t = 0.0f;
    Hit pending = best;

    if (params.is_resumed != 0u && node != kNone) {
        BvhState state = bvh_states[index];
        node = state.node;
        best_t = state.t;
        if (node != kNone && state.instance != kNone) {
            inside = state.instance;
            leave_to = bvh_skips[skips + inside];
            BvhInstance placed = bvh_instances[bvh_nodes[inside].link];
            instance = placed.instance;
            order = octantInside(placed, octant);
            skips = order * params.node_count;
            lane = placedLane(placed, ray.origin, direction);
        }
    }

    while (node != kNone || cursor != last) {
        // From leaf to leaf, until something rare happens.
        uint entered = kNone; // the leaf of an instance
        bool is_going = true;
        while (is_going) {
            // Find the next leaf whose box the ray meets.
            while (node < kBvhLeave && cursor == last && entered == kNone &&
                   steps < params.step_limit) {
                BvhNode visited = bvh_nodes[node];
                uint skip = bvh_skips[skips + node];
                bool is_met = meetsBox(lane, visited, tmin, best_t);
                bool is_inner = visited.info < kBvhLeaf;
                bool is_left_nearer = ((order >> (visited.info & 3u)) & 1u) == 0u;
                bool is_reached = is_met && !is_inner;
                bool is_instance = visited.info == kBvhInstanced;
                entered = is_reached && is_instance ? node : kNone;
                cursor = is_reached && !is_instance ? visited.link : 0u;
                last = is_reached && !is_instance ? visited.link + visited.info - kBvhLeaf : 0u;
                node = is_met && is_inner ? (is_left_nearer ? node + 1u : visited.link) : skip;
                steps += 1u + last - cursor;
            }

            // Test its triangles.
            while (cursor != last && !is_pending) {
                BvhTriangle triangle = bvh_triangles[cursor];
                cursor += 1u;
                float t;
                float slope;
                bool is_hit = crossing(lane, triangle, t, slope) && t >= tmin;
                Hit hit;
                hit.instance = instance == kNone ? triangle.instance : instance;
                hit.primitive = triangle.primitive;
                if (is_any_enough) {
                    is_hit = is_hit && t <= best_t;
                } else {
                    bool is_front =
                        (triangle.flags & kBvhFlipped) == 0u ? slope < 0.0f : slope > 0.0f;
                    bool is_first =
                        hit.instance < best.instance ||
                        (hit.instance == best.instance && hit.primitive < best.primitive);
                    is_hit = is_hit && (t < best_t || (t == best_t && is_first)) &&
                             (is_front || (triangle.flags & kBvhTwoSided) != 0u);
                }
                bool is_masked = (triangle.flags & kBvhMasked) != 0u;
                is_pending = is_hit && is_masked;
                pending_t = t;
                pending = hit;
                if (is_hit && !is_masked) {
                    is_found = true;
                    best_t = t;
                    best = hit;
                    cursor = is_any_enough ? last : cursor;
                    node = is_any_enough ? kNone : node;
                }
            }
            is_going = cursor == last && node < kBvhLeave && entered == kNone &&
                       steps < params.step_limit && !is_pending;
        }

        // A hit of a masked triangle counts where it is solid.
        if (is_pending && isSolid(ray, pending)) {
            is_found = true;
            best_t = pending_t;
            best = pending;
            cursor = is_any_enough ? last : cursor;
            node = is_any_enough ? kNone : node;
        }
        is_pending = false;

        if (entered != kNone) {
            // Into the tree of an instanced mesh.
            BvhInstance placed = bvh_instances[bvh_nodes[entered].link];
            inside = entered;
            leave_to = node;
            instance = placed.instance;
            order = octantInside(placed, octant);
            skips = order * params.node_count;
            lane = placedLane(placed, ray.origin, direction);
            node = placed.root;
        } else if (node == kBvhLeave && cursor == last) {
            // Back into the world's.
            node = leave_to;
            inside = kNone;
            instance = kNone;
            order = octant;
            skips = order * params.node_count;
            lane = makeLane(ray.origin, direction, params.extent);
        }
        if (steps >= params.step_limit && cursor == last)
            break;
    }

    // Where it goes on.
    BvhState state;
    state.node = node;
    state.instance = inside;
    state.t = best_t;
    bvh_states[index] = state;
    if (node != kNone)
        bvh_unfinished[0] = 1u; // whoever writes it writes the same
    return is_found;
}

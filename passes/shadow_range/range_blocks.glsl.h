// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint source;      ///< first range of the finer level in the first face
    uint source_edge; ///< blocks along its edge
    uint level;       ///< first range of this level there
    uint edge;
    uint face_ranges; ///< from face to face
    uint spread;      ///< of this level's blocks in the finer: 2 hsm, 1 nbuffer
    uint offset;      ///< of a block's second half in the finer level's blocks
};
HONE_PARAMS(Params)
HONE_WRITE(uvec2, ranges)

/// A block from its quarters. What is over the face's edge is left out.
void kernel(uint index) {
    uint blocks = params.edge * params.edge;
    uint first = index / blocks * params.face_ranges;
    uint x = index % blocks % params.edge * params.spread;
    uint y = index % blocks / params.edge * params.spread;
    uint nearest = 0x7f7fffffu;
    uint farthest = 0u;
    uint broken = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        uint column = min(x + (i & 1u) * params.offset, params.source_edge - 1u);
        uint row = min(y + (i >> 1u) * params.offset, params.source_edge - 1u);
        uvec2 quarter = ranges[first + params.source + row * params.source_edge + column];
        nearest = min(nearest, quarter.x & 0x7fffffffu);
        farthest = max(farthest, quarter.y);
        broken = broken | (quarter.x & 0x80000000u);
    }
    ranges[first + params.level + index % blocks] = uvec2(nearest | broken, farthest);
}

// SPDX-License-Identifier: Apache-2.0

struct Params {
    uint used;
    vec3 scale;
    uint offset;
};
HONE_PARAMS(Params)
HONE_READS(uint, summands, 6)
HONE_READ(vec3, unused)
HONE_WRITE(uint, sum)

void kernel(uint index) {
    uint total = params.offset + uint(params.scale.x + params.scale.y + params.scale.z);
    for (uint k = 0u; k < params.used; ++k)
        total += summands[k].data[index];
    sum[index] += total;
}

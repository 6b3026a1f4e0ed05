// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/bvh/bvh_kernels.h"

#include "hone/backends/bvh/bvh.glsl.h"
#include "hone/core/device/kernel.glsl.h"

#include "hone_spirv/bvh_closest.h"
#include "hone_spirv/bvh_occluded.h"

namespace hone {
namespace {

struct BvhClosest : HostKernel {
    using HostKernel::HostKernel;
#include "hone/backends/bvh/bvh_closest.glsl.h"
};

struct BvhOccluded : HostKernel {
    using HostKernel::HostKernel;
#include "hone/backends/bvh/bvh_occluded.glsl.h"
};

static_assert(sizeof(BvhQueryParams) == sizeof(BvhClosest::Params) &&
              sizeof(BvhQueryParams) == sizeof(BvhOccluded::Params));

} // namespace

const Kernel kBvhClosest = makeKernel<BvhClosest>("bvh_closest", spirv::bvh_closest);
const Kernel kBvhOccluded = makeKernel<BvhOccluded>("bvh_occluded", spirv::bvh_occluded);

} // namespace hone

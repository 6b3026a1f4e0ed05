// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/bvh/bvh_kernels.h"

#include "hone/backends/bvh/bvh.glsl.h"
#include "hone/core/device/kernel.glsl.h"

#include "hone_spirv/bvh_closest.h"
#include "hone_spirv/bvh_closest_alone.h"
#include "hone_spirv/bvh_occluded.h"
#include "hone_spirv/bvh_occluded_alone.h"

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

// On the host an invocation is alone anyway: both kernels have one native build.
const BvhKernels kBvhClosest{
    .together = makeKernel<BvhClosest>("bvh_closest", spirv::bvh_closest),
    .alone = makeKernel<BvhClosest>("bvh_closest_alone", spirv::bvh_closest_alone),
    .answers = "hits",
};
const BvhKernels kBvhOccluded{
    .together = makeKernel<BvhOccluded>("bvh_occluded", spirv::bvh_occluded),
    .alone = makeKernel<BvhOccluded>("bvh_occluded_alone", spirv::bvh_occluded_alone),
    .answers = "occluded",
};

} // namespace hone

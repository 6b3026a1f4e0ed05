// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/each_build.h"

namespace hone {

const char* name(Build build) {
    return build == Build::kHost ? "OnHost" : "OnDevice";
}

void EachBuild::SetUp() {
    if (GetParam() == Build::kDevice)
        VulkanTest::SetUp();
}

PassRun EachBuild::pass(PassType type) {
    return GetParam() == Build::kHost ? PassRun(std::move(type))
                                      : PassRun(std::move(type), device());
}

PassRun EachRasterBuild::pass(PassType type) {
    return {std::move(type), device(), GetParam() == Build::kHost};
}

} // namespace hone

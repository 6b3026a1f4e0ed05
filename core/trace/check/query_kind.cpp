// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/check/query_kind.h"

namespace hone {

std::string witnessText(const Scene& scene, const Difference& difference) {
    if (difference.witness.instance == kNone)
        return "the ray surely meets nothing";
    return "the ray surely meets " +
           ClosestKind::text(scene, difference.witness, difference.witness_t);
}

} // namespace hone

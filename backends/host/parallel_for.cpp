// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/host/parallel_for.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace hone {

void hostParallelFor(std::size_t count, std::size_t grain,
                     void (*body)(void* context, std::size_t begin, std::size_t end),
                     void* context) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(grain, 1)),
        [&](const tbb::blocked_range<std::size_t>& range) {
            body(context, range.begin(), range.end());
        },
        tbb::simple_partitioner());
}

} // namespace hone

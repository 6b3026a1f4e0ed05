// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace hone {

/// Calls body(context, begin, end) for ranges of at most `grain` that cover [0, count) once, on all
/// cores of the calling thread's oneTBB arena; returns when all are done.
void hostParallelFor(std::size_t count, std::size_t grain,
                     void (*body)(void* context, std::size_t begin, std::size_t end),
                     void* context);

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace hone {

/// The threads that core and plug-ins may use, as core has none of its own: calls
/// body(context, begin, end) for ranges of at most `grain` that cover [0, count) once, and returns
/// when all are done. hostParallelFor() of backends/host is one.
using ParallelFor = void (*)(std::size_t count, std::size_t grain,
                             void (*body)(void* context, std::size_t begin, std::size_t end),
                             void* context);

} // namespace hone

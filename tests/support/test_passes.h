// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/compiled_graph.h"

namespace hone {

/// A refinement in miniature, for tests of graphs: passes with the ports and names of the real
/// ones and arithmetic that fits into a head.
///
///     raster   scene, camera -> color (every pixel the camera's x), depth (1)
///     error.a  depth, color? -> error (expect = bound = scale * (pixel + 1))     kernel
///     combine  errors[weight] -> error (weighted sum; mode max: greatest)
///     sort     error -> order (pixels from the last to the first), cursor (0)
///     request  order, state -> requests (the next `batch` of the order), state in place;
///              counts "pixels"
///     trace    requests, scene? -> samples (radiance = pixel); counts "rays.primary"
///     blend    image, samples -> image in place (the sample's radiance)
///     add      color -> color + amount                                           kernel
///     bump     color -> color in place, + 1                                      kernel
///     mix      a, b -> color (a + b)                                             kernel
///     brightest  color -> value (the greatest x)
///     draw     camera -> depth; rasterises, so it needs a device
struct TestCatalog {
    TestCatalog();
    PassRegistry passes;
    TraceBackendRegistry backends; ///< "brute" and "embree", neither of which is ever made
    ShaderCompiler shaders;        ///< a file with "bad" in it is wrong; others are the pass add
    TestCatalog(const TestCatalog&) = delete;
    TestCatalog& operator=(const TestCatalog&) = delete;
    [[nodiscard]] Catalog catalog() const { return {&passes, &backends, &shaders}; }
};

} // namespace hone

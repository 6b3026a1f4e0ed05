// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/brute/brute_backend.h"
#include "hone/backends/embree/embree_backend.h"
#include "hone/tests/conformance/conformance.h"

int main(int argc, char** argv) {
    using namespace hone;
    test::addTracer({.name = "brute", .make = makeBruteBackend, .is_brute = true});
    test::addTracer({.name = "embree", .make = makeEmbreeBackend});
    // Every mesh with two instances gets a tree of its own.
    test::addTracer({.name = "embree_instances",
                     .make = [] { return makeEmbreeBackendWith({.flatten_triangles = 0}); }});
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

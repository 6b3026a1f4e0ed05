// SPDX-License-Identifier: Apache-2.0
//
// An error metric of one's own, out of hone's tree: pixels at silhouettes are refined first, for
// there a raster image is wrong by what antialiasing would blend. To use it:
//     cmake -S . -B build -DCMAKE_PREFIX_PATH=/where/hone/is/installed && cmake --build build
//     hone render silhouettes.json --plugin build/libcustom_pass.so -o out
// hone_pass.hpp says what a pass may do.
#include <hone_pass.hpp>

#include <algorithm>
#include <cmath>

namespace {

namespace hp = hone::plugin;

struct Silhouettes {
    hp::In<float> depth;
    hp::Out<hp::Error> error;
    float threshold = 0.05f;

    static void declare(hp::Declare<Silhouettes>& pass) {
        pass.called("error.silhouettes", "Flags pixels beside which the depth jumps");
        pass.in(&Silhouettes::depth, "depth", "Depth", "of the raster image");
        pass.out(&Silhouettes::error, "error", "Error",
                 "the jump, as a share of the depth; at most 1");
        pass.param(&Silhouettes::threshold, "threshold", "least jump that counts",
                   {.min = 0, .max = 1});
    }

    void execute(const hp::Run& run) {
        run.forEachPixel([this](int x, int y) {
            const float here = depth(x, y);
            float jump = 0;
            for (const float there : {depth.clamped(x - 1, y), depth.clamped(x + 1, y),
                                      depth.clamped(x, y - 1), depth.clamped(x, y + 1)})
                if (here != there) // 0 is the sky: then the jump is 1
                    jump = std::max(jump, std::abs(here - there) / std::max(here, there));
            error(x, y) = jump > threshold ? hp::Error{jump, 1} : hp::Error{0, 0};
        });
    }
};

} // namespace

HONE_PASS_PLUGIN(Silhouettes, {.name = "silhouettes",
                               .version = "1.0",
                               .license = "Apache-2.0",
                               .doc = "An error metric."})

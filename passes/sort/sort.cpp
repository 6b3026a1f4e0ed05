// SPDX-License-Identifier: Apache-2.0
//
// sort: all pixels in the order in which they are to be refined.
//
// The order is total: expected error descending, pixel ascending. What is not finite counts as 1,
// what is negative as 0, and -0 is 0.
//
// strategy select  cuts that order into batches of `batch` pixels without sorting: batch k holds
//                  exactly the pixels of ranks k * batch to (k + 1) * batch - 1, in tile order
//                  (tile_order.h), which is the order in which they trace fastest. `batch` should
//                  be that of request.
//          radix   sorts by the full error, as the paper does. request puts each batch it takes in
//                  tile order, so both strategies request the same lists.
//
// in   error  Error
// out  order  PixelList, each pixel once
// params  strategy  select, radix
//         batch     select: pixels in a batch (8192); 0 = all in one
//         scope     all: every pixel is listed; flagged: only those with bound > 0
// counters  error_pixels     pixels with bound > 0
//           error_share_ppm  their share of all pixels, in millionths
//
//     "sort": { "type": "sort", "in": { "error": "combine.error" }, "params": { "batch": "$batch" }
//     }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.5 (sorting by error, refining in batches).
#include "hone/core/image/tile_order.h"
#include "hone/passes/passes.h"
#include "hone/passes/sort/error_key.h"
#include "hone/passes/sort/radix_sort.h"
#include "hone/passes/sort/select.h"

#include <algorithm>
#include <numeric>

namespace hone {
namespace {

class SortPass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const std::span<const vec2> errors = context.in("error").as<vec2>();
        Value& out = context.out("order");
        const std::span<uint> order = out.capacity<uint>();
        const TileOrder tiles(context.extent);
        const bool flagged_only = context.param<std::string>("scope") == "flagged";
        const bool selects = context.param<std::string>("strategy") == "select";
        const uint wanted_batch = context.param<uint>("batch");
        const std::size_t batch = wanted_batch == 0 ? errors.size() : wanted_batch;

        ErrorCounts found;
        if (selects && errors.size() <= batch * Selector::kMaxBatches) {
            found = selector_.select(tiles, errors, batch, flagged_only, order, radix_);
        } else {
            found = sortAll(errors, flagged_only, order);
            if (selects)
                sortBatches(tiles, batch, order.first(found.listed));
        }
        out.count = static_cast<uint>(found.listed);
        context.counters->set("error_pixels", found.error_pixels);
        context.counters->set("error_share_ppm", found.error_pixels * 1'000'000 / errors.size());
    }

private:
    ErrorCounts sortAll(std::span<const vec2> errors, bool flagged_only, std::span<uint> order) {
        ErrorCounts found;
        found.error_pixels = static_cast<std::size_t>(std::ranges::count_if(errors, isErrorPixel));
        found.listed = flagged_only ? found.error_pixels : errors.size();
        if (flagged_only) {
            listed_.clear();
            for (uint pixel = 0; pixel < errors.size(); ++pixel)
                if (isErrorPixel(errors[pixel]))
                    listed_.push_back(pixel);
        }
        const auto source = [&](std::size_t i) {
            const uint pixel = flagged_only ? listed_[i] : static_cast<uint>(i);
            return KeyedPixel{descendingErrorKey(errors[pixel].x), pixel};
        };
        radix_.sort(kErrorKeyBits, source, order.first(found.listed));
        return found;
    }

    /// Puts each batch in tile order. Only for batches so small that comparing is no cost.
    static void sortBatches(const TileOrder& tiles, std::size_t batch, std::span<uint> order) {
        const std::size_t batches = (order.size() + batch - 1) / batch;
        tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t index) {
            const std::size_t begin = index * batch;
            std::ranges::sort(order.subspan(begin, std::min(batch, order.size() - begin)), {},
                              [&](uint pixel) { return tiles.key(pixel); });
        });
    }

    Selector selector_;
    RadixSorter radix_;
    std::vector<uint> listed_;
};

} // namespace

PassType sortPass() {
    return PassType("sort", "Lists all pixels in the order in which they are to be refined")
        .in("error", types::kError, "expect orders, bound gates (scope flagged)")
        .out("order", types::kPixelList, "each pixel once, greatest expected error first",
             [](const SizeQuery& query) { return std::size_t{query.extent.x} * query.extent.y; })
        .param("strategy", {"select", "radix"},
               "select: exact batches in tile order; radix: the full order")
        .param("batch", 8192u, {.min = 0, .max = {}},
               "select: pixels in a batch, the same as request's; 0 = all in one")
        .param("scope", {"all", "flagged"}, "flagged: only pixels with bound > 0 are listed")
        .implementedBy<SortPass>(Domain::kHost);
}

} // namespace hone
